"""Costs of work: shares of the damage by revolution, hour, day and recording; life under another load."""
import numpy
import pandas

from report.blocks import Block, Details, Note, Table, folded
from report.cycles import channels_of
from report.database import FLEET
from report.formats import in_words, moment, number, utc
from report.subjects import MOST_TURNS_ONE_BY_ONE

SLOPE = 5.0  # where no S-N curve is given
PARTS = (0.01, 0.03, 0.1, 0.3, 0.5)
DEAREST = 10
LEAST_TURNS = 3.0  # turns: of fewer a share is mostly the rounding of their number
FACTORS = (0.8, 0.9, 0.95, 1.05, 1.1, 1.2)
MOST_RECORDINGS = 500  # one by one
HOUR_NS = 3600 * 10 ** 9


def judged_channel(channels):
    """Channel with an S-N curve if there is one, else the force along the tool."""
    curved = [c for c in channels if c.curve is not None]
    along = [c for c in channels if c.name.endswith("force_z")]
    return (curved or along or channels)[0]


def rule_of(channel):
    return f"{in_words(channel.name)}, " + ("S-N curve" if channel.curve else f"slope {SLOPE:g}")


def damage_of_each(channel, ranges, means):
    """Damage of one cycle of each range and mean: by the S-N curve, else relative at SLOPE."""
    if channel.curve is not None:
        return channel.curve.of_each(ranges, means)[0]
    least, greatest, _ = channel.count.grid
    return (ranges / (greatest - least)) ** SLOPE


def damage_of(channel):
    """Damage of all counted cycles."""
    ranges, means, counts = channel.cycles
    return (counts * damage_of_each(channel, ranges, means)).sum()


def turn_costs(subject, channel):
    """Revolutions with loads: damage by the range of the revolution alone, stamp_ns, run, turn, peak [kN]."""
    if subject.total("turns") > MOST_TURNS_ONE_BY_ONE or "turn_loads" not in subject.database.tables():
        return pandas.DataFrame({"damage": []})
    rows = subject.frame(
        "turn, stamp_ns, turn_loads.minimum AS least, turn_loads.maximum AS greatest, amplitude / 1000 AS peak "
        "FROM channels JOIN turn_loads USING(run_id, channel) JOIN turns USING(run_id, turn) WHERE {runs} AND name = ? "
        "ORDER BY turn", channel.name).dropna(subset=["stamp_ns", "least", "greatest"])
    return rows.assign(damage=damage_of_each(channel, rows.greatest - rows.least, 0.5 * (rows.greatest + rows.least)))


def dearest_share(damages, part):
    """Share of the damage that is due to the most damaging part of the revolutions."""
    return damages.nlargest(max(1, round(part * len(damages)))).sum() / damages.sum()


def shares_table(caption, title, counted, groups):
    """groups: (name, count, damage), equal names together; nothing where there is one group alone."""
    sums = pandas.DataFrame(groups, columns=["name", "count", "damage"]).groupby("name", sort=False).sum()
    if len(sums) < 2:
        return None
    parts = 100.0 * sums / sums.sum().replace(0, 1)
    rows = [[name, int(count), number(share, 3), number(damage, 3)]
            for name, count, share, damage in zip(sums.index, sums["count"], parts["count"], parts.damage)]
    return folded(Table(caption, [title, counted, f"{counted} [%]", "Damage [%]"], rows), 24, f"rows: {caption}")


def grouped_table(caption, title, turns, stretch_ns, name_of):
    """Shares by stretches of time. name_of(stamp_ns): name of the stretch that begins then."""
    begins = (turns.stamp_ns // stretch_ns * stretch_ns).astype("int64")
    return shares_table(caption, title, "Turns", [(name_of(at), len(damage), damage.sum())
                                                  for at, damage in turns.damage.groupby(begins)])


def dearest_turns(subject, turns):
    names = subject.recordings()
    dearest = turns.sort_values(["damage", "stamp_ns"], ascending=[False, True]).head(DEAREST)
    rows = [[moment(turn.stamp_ns), names[turn.run], int(turn.turn),
             number(100.0 * turn.damage / turns.damage.sum(), 2), turn.peak] for turn in dearest.itertuples()]
    return Table("Most damaging revolutions", ["End (UTC)", "Recording", "Turn", "Damage [%]", "Peak force [kN]"], rows)


def by_turns(subject, channel):
    """Sentences and tables about the revolutions, and the details of the dearest; nothing where none did damage."""
    turns = turn_costs(subject, channel)
    held, counted = turns.damage.sum(), damage_of(channel)
    if not held > 0.0:
        return [], []
    words = "; ".join(f"{100 * part:g} % of the blows did {number(100.0 * dearest_share(turns.damage, part), 3)} %"
                      for part in PARTS if part * len(turns) >= LEAST_TURNS)
    share = number(100.0 * held / counted, 3) if counted > 0.0 else None
    return [f"Of the damage {words}." if words else None,
            share and Note(f"A revolution counts here with its range alone: that is {share} % of the damage of all counted "
                           "cycles."),
            grouped_table("Damage by day", "Day (UTC)", turns, 24 * HOUR_NS, lambda stamp: utc(stamp)[:10]),
            grouped_table("Damage by hour", "Hour (UTC)", turns, HOUR_NS, lambda stamp: moment(stamp, "minutes"))
            ], [Details("The most damaging revolutions", [dearest_turns(subject, turns)])]


def by_recording(subject, channel):
    """Shares by the counted cycles of each run, and by day for a machine of a fleet."""
    if len(subject.runs) > MOST_RECORDINGS:
        return []
    pieces = [(name, run.get("day") or "?", run["blows"] or 0, damage_of(piece))
              for name, run in zip(subject.recordings(), subject.runs)
              for piece in channels_of(subject.database, "r.run_id = ? AND c.name = ?", run["run_id"], channel.name)]
    tables = [shares_table("Damage by recording", "Recording", "Blows", [(name, *shares) for name, _, *shares in pieces])]
    if subject.database.kind == FLEET:
        tables.append(shares_table("Damage by day", "Day (UTC)", "Blows", [(day, *shares) for _, day, *shares in pieces]))
    return tables


def life_factors(channel, factors):
    """Life over that of now, by the S-N curve, with all loads multiplied by each factor."""
    ranges, means, counts = channel.cycles
    damages = [(counts * channel.curve.of_each(ranges * factor, means * factor)[0]).sum() for factor in (1.0, *factors)]
    return [damages[0] / damage if damage > 0.0 else float("inf") for damage in damages[1:]]


def doubling_factor(channel):
    """Factor of the load at which the life by the channel's curve is twice as long, to 0.001."""
    factors = numpy.arange(200, 1001) * 0.001
    return max((factor for factor, life in zip(factors, life_factors(channel, factors)) if life >= 2.0), default=None)


def back_calculation(channels):
    """Life over that of now by the load over that of now."""
    ways = [(f"slope {m:g}", [factor ** -m for factor in FACTORS], 2.0 ** (-1.0 / m)) for m in (3.0, 5.0, 10.0)]
    ways += [(in_words(c.name), life_factors(c, FACTORS), doubling_factor(c)) for c in channels
             if c.curve is not None and c.damage()[0] > 0.0]
    words = "; ".join(f"{name}: {number(double, 3)} of the load" for name, _, double in ways if double)
    rows = [[number(factor), *(number(lives[at], 3) for _, lives, _ in ways)] for at, factor in enumerate(FACTORS)]
    table = Table("Life over that of now", ["Load over that of now", *(name for name, _, _ in ways)], rows)
    return Block("Another load, another life", [f"Twice the life: {words}.", table])


def costs(subject, channels):
    if not channels:
        return ["No channel was counted."]
    channel = judged_channel(channels)
    turns, dearest = by_turns(subject, channel)
    shares = [*turns, *by_recording(subject, channel), *dearest]
    return [Block(f"Share of the damage: {rule_of(channel)}", shares) if any(shares) else None, back_calculation(channels)]
