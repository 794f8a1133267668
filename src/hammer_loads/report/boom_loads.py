"""Loads of hull, boom joints, cylinders and sections, a value per turn each."""
from report.names import without_unit
from report.markup import Raw, details, in_unit, number, paragraph, scaled, table
from report.series import Segments

MOST_POINTS = 240


def bands_of(subject):
    """{(name, unit): [[turns, least, sum of means, greatest], Segments]} of all channels with rows per turn."""
    found, first = {}, subject.first_ns or 0
    if "turn_loads" not in subject.database.tables():
        return found
    together = max(1, -(-subject.total("turns") // MOST_POINTS))
    for run in subject.runs:
        names = {row["channel"]: (row["name"], row["unit"] or "") for row in subject.database.records(
            "SELECT channel, name, unit FROM channels WHERE run_id = ? ORDER BY channel", run["run_id"])}
        for key in names.values():
            if key in found:
                found[key][1].begin_run()
        stamps = dict(subject.database.rows("SELECT turn, stamp_ns FROM turns WHERE run_id = ?", run["run_id"]))
        for channel, count, turn, least, middle, greatest in subject.database.rows(
                "SELECT channel, count(*), min(turn), min(minimum), avg(mean), max(maximum) FROM turn_loads "
                "WHERE run_id = ? AND minimum IS NOT NULL GROUP BY channel, turn / ? ORDER BY channel, turn",
                run["run_id"], together):
            key = names.get(channel, (f"channel {channel}", ""))
            if key not in found:
                found[key] = [[0, least, 0.0, greatest], Segments()]
                found[key][1].begin_run()
            tally, segments = found[key]
            found[key][0] = [tally[0] + count, min(tally[1], least), tally[2] + count * (middle or 0.0),
                             max(tally[3], greatest)]
            at = stamps.get(turn)
            if at is not None:
                factor = in_unit(key[1])[0]
                segments.add_band((at - first) * 1e-9, *(factor * (v if v is not None else least)
                                                         for v in (least, middle, greatest)))
    return found


def boom_loads(subject, charts):
    bands = bands_of(subject)
    if not bands:
        return paragraph("The file holds no loads per turn.")
    rows, choices = [], []
    for (name, unit), (tally, segments) in bands.items():
        factor, shown = in_unit(unit)
        rows.append([without_unit(name), shown] + [number(scaled(v, factor)) for v in
                                     (tally[1], tally[2] / tally[0], tally[3])] + [tally[0]])
        choices.append((name, without_unit(name), shown, segments.thinned(MOST_POINTS)))
    strongest = max(bands, key=lambda key: key[0].startswith("joint_loads") and key[1] == "Nm" and
                    bands[key][0][3] - bands[key][0][1])
    choices.sort(key=lambda choice: choice[0] != strongest[0])
    choices = [choice[1:] for choice in choices]
    content = table("Loads over all turns", ["Channel", "Unit", "Least", "Mean of turns", "Greatest", "Turns"], rows)
    if not any(name.startswith("section_loads/") for name, _ in bands):
        content += paragraph("No sections: the boom file names none, or there was no robot description.")
    words = paragraph("Line: mean of the turns; band: least and greatest within them, kept where turns are put together.",
                      "note")
    return Raw(words + charts.of_choice("Load per turn", choices, subject.first_ns) +
               (content if len(rows) <= 8 else details(f"All {len(rows)} channels as a table", content)))
