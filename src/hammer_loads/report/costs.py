"""Which work cost what: shares of the damage by turn, hour, day and recording; what another load would do to the life."""
import bisect

from report.channel import Channel
from report.database import FLEET
from report.markup import Raw, block, details, moment, number, paragraph, scaled, table, utc
from report.names import recording_of, without_unit
from report.subjects import MOST_TURNS_ONE_BY_ONE, add_piece

SLOPE = 5.0  # where no S-N curve is given
PARTS = (0.01, 0.03, 0.1, 0.3, 0.5)
DEAREST = 10
LEAST_TURNS = 3.0  # turns: of fewer a share is mostly the rounding of their number
FACTORS = (0.8, 0.9, 0.95, 1.05, 1.1, 1.2)
MOST_RECORDINGS = 500  # one by one
HOUR_NS = 3600 * 10 ** 9


def judged_channel(channels):
    """With an S-N curve if one is given, else the force along the tool."""
    curved = [c for c in channels if c.curve is not None]
    along = [c for c in channels if c.name.endswith("force_z_N")]
    return (curved or along or channels)[0]


def rule_of(channel):
    return "S-N curve" if channel.curve else f"slope {SLOPE:g}"


def damage_of(channel, cycles):
    """By the curve, else relative at SLOPE. cycles: (range, mean, count)."""
    if channel.curve is not None:
        return channel.curve.damage(cycles)[0]
    return sum(n * (r / (channel.count.greatest - channel.count.least)) ** SLOPE for r, _, n in cycles)


def turn_costs(subject, channel):
    """(damage of the turn's range alone, stamp_ns, run, turn) of every turn with loads, in the order of time."""
    if subject.total("turns") > MOST_TURNS_ONE_BY_ONE or "turn_loads" not in subject.database.tables():
        return []
    sql = ("SELECT l.maximum - l.minimum, 0.5 * (l.maximum + l.minimum), t.stamp_ns, l.turn FROM turn_loads l "
           "JOIN channels c USING(run_id, channel) JOIN turns t USING(run_id, turn) WHERE l.run_id = ? AND c.name = ? "
           "AND l.minimum IS NOT NULL AND l.maximum IS NOT NULL AND t.stamp_ns IS NOT NULL ORDER BY l.turn")
    return [(damage_of(channel, [(reach, mean, 1.0)]), stamp, run["run_id"], turn) for run in subject.runs
            for reach, mean, stamp, turn in subject.database.rows(sql, run["run_id"], channel.name)]


def dearest_share(costs, part):
    """Share of the damage that the dearest part of the turns did."""
    ordered = sorted((cost[0] for cost in costs), reverse=True)
    count = max(1, round(part * len(ordered)))
    return sum(ordered[:count]) / (sum(ordered) or 1.0)


def grouped_table(caption, title, costs, key_of):
    """Share of turns and of damage; nothing where there is one group alone."""
    groups = {}
    for cost in costs:
        tally = groups.setdefault(key_of(cost), [0, 0.0])
        tally[0] += 1
        tally[1] += cost[0]
    return shares_table(caption, title, "Turns", [(name, count, damage) for name, (count, damage) in groups.items()])


def shares_table(caption, title, counted, groups):
    """groups: (name, count, damage)."""
    if len(groups) < 2:
        return ""
    count_all = sum(count for _, count, _ in groups) or 1
    damage_all = sum(damage for _, _, damage in groups) or 1.0
    rows = [[name, number(count), number(100.0 * count / count_all, 3), number(100.0 * damage / damage_all, 3)]
            for name, count, damage in groups]
    content = table(caption, [title, counted, f"{counted} [%]", "Damage [%]"], rows)
    return content if len(rows) <= 24 else details(f"{caption}: {len(rows)} rows", content)


def dearest_turns(subject, costs):
    total = sum(cost[0] for cost in costs) or 1.0
    names, rows = recording_of(subject), []
    for cost, stamp, run, turn in sorted(costs, key=lambda c: (-c[0], c[1]))[:DEAREST]:
        peak = subject.database.value("SELECT amplitude_N FROM turns WHERE run_id = ? AND turn = ?", run, turn)
        rows.append([moment(stamp), names.get(run, "?"), number(turn), number(100.0 * cost / total, 2),
                     number(scaled(peak, 1e-3))])
    return details(f"The {len(rows)} dearest turns", table(
        "Dearest turns", ["End (UTC)", "Recording", "Turn", "Damage [%]", "Peak force [kN]"], rows))


def by_recording(subject, channel):
    """By the counted cycles of each run."""
    if len(subject.runs) > MOST_RECORDINGS:
        return ""
    names, groups = recording_of(subject), {}
    for run in subject.runs:
        for row in subject.database.records("SELECT * FROM channels WHERE run_id = ? AND name = ? AND counted",
                                            run["run_id"], channel.name):
            piece = Channel.of(row, run["equivalent_cycles_per_hour"])
            add_piece(piece, subject.database, run, row)
            groups[run["run_id"]] = damage_of(channel, piece.count.ranges_and_means())
    rows = [(names[run["run_id"]], run["blows"] or 0, groups[run["run_id"]]) for run in subject.runs
            if run["run_id"] in groups]
    content = shares_table("Damage by recording", "Recording", "Blows", rows)
    if subject.database.kind == FLEET:
        days = {}
        for run in subject.runs:
            if run["run_id"] in groups:
                tally = days.setdefault(run["day"] or "?", [0, 0.0])
                tally[0] += run["blows"] or 0
                tally[1] += groups[run["run_id"]]
        content += shares_table("Damage by day", "Day (UTC)", "Blows", [(day, *tally) for day, tally in days.items()])
    return content


def which_turns(subject, channel):
    costs = turn_costs(subject, channel)
    if not any(cost[0] > 0.0 for cost in costs):
        return ""
    words = "; ".join(f"{100 * part:g} % of the blows did {number(100 * dearest_share(costs, part), 3)} %"
                      for part in PARTS if part * len(costs) >= LEAST_TURNS)
    counted = damage_of(channel, channel.count.ranges_and_means())
    held = sum(cost[0] for cost in costs)
    content = paragraph(f"Of the damage {words}.") if words else ""
    if counted > 0.0:
        content += paragraph(f"A turn counts here with its range alone: that is {number(100.0 * held / counted, 3)} % of "
                             "the damage of all counted cycles.", "note")
    content += grouped_table("Damage by day", "Day (UTC)", costs, lambda cost: utc(cost[1])[:10])
    content += grouped_table("Damage by hour", "Hour (UTC)", costs,
                             lambda cost: moment(cost[1] // HOUR_NS * HOUR_NS, "minutes"))
    return content + dearest_turns(subject, costs)


def life_factor(channel, cycles, factor, slope=None):
    """Of the life, where all loads are `factor` times as large; by the slope, else by the channel's curve."""
    if slope is not None:
        return factor ** -slope
    scaled_cycles = [(r * factor, mean * factor, n) for r, mean, n in cycles]
    now, then = channel.curve.damage(cycles)[0], channel.curve.damage(scaled_cycles)[0]
    return now / then if then > 0.0 else float("inf")


def doubling_factor(channel, cycles):
    """Factor of the load at which the life by the channel's curve is twice as long, to 0.001."""
    factors = [0.001 * i for i in range(200, 1001)]
    at = bisect.bisect_right([-life_factor(channel, cycles, f) for f in factors], -2.0)
    return factors[at - 1] if at > 0 else None


def back_calculation(channels):
    ways = [(f"slope {m:g}", lambda f, m=m: life_factor(None, None, f, m), 2.0 ** (-1.0 / m)) for m in (3.0, 5.0, 10.0)]
    for channel in channels:
        cycles = channel.count.ranges_and_means()
        if channel.curve is not None and channel.curve.damage(cycles)[0] > 0.0:
            ways.append((without_unit(channel.name), lambda f, c=channel, y=cycles: life_factor(c, y, f),
                         doubling_factor(channel, cycles)))
    words = "; ".join(f"{name}: {number(double, 3)} of the load" for name, _, double in ways if double)
    rows = [[number(factor)] + [number(way(factor), 3) for _, way, _ in ways] for factor in FACTORS]
    return (paragraph(f"Twice the life: {words}.") +
            table("Life over that of now", ["Load over that of now", *(name for name, _, _ in ways)], rows))


def costs(subject, channels):
    if not channels:
        return paragraph("No channel was counted.")
    channel = judged_channel(channels)
    shares = which_turns(subject, channel) + by_recording(subject, channel)
    title = f"Share of the damage: {without_unit(channel.name)}, {rule_of(channel)}"
    return Raw((block(title, shares) if shares else "") + block("Another load, another life", back_calculation(channels)))
