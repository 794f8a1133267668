"""Load cycles of a machine over all its runs. Pieces add exactly: closed cycles add, residues join in time order."""
from report.channel import Channel
from report.damage import SLOPES

SAME = "b.machine = ? AND r.machine = ? AND c.name = ? AND c.least = ? AND c.greatest = ? AND c.classes = ?"
OF_CHANNEL = "FROM bags b JOIN runs r USING(bag_id) JOIN channels c USING(run_id) "
CHANNELS = ("SELECT r.machine, c.name, c.least, c.greatest, c.classes, sum(r.duration), sum(c.samples), "
            "sum(c.skipped), sum(c.below), sum(c.above), sum(c.gaps), min(c.minimum), max(c.maximum), "
            "sum(c.mean_std * c.samples), sum(CASE WHEN c.mean_std IS NULL THEN 0 ELSE c.samples END), "
            "max(r.equivalent_cycles_per_hour), sum(c.range_own_std * c.samples), "
            "sum(c.range_systematic_std * c.samples), "
            "sum(CASE WHEN c.range_own_std IS NULL THEN 0 ELSE c.samples END) " + OF_CHANNEL + "WHERE b.machine = ? AND c.counted = 1 "
            "GROUP BY r.machine, c.name, c.least, c.greatest, c.classes ORDER BY r.machine, min(c.channel)")
LATEST = ("SELECT c.unit, c.sn_knee_range, c.sn_knee_cycles, c.sn_slope, c.sn_slope_below, "
          "c.mean_stress_sensitivity " + OF_CHANNEL + "WHERE " + SAME + " ORDER BY r.first_stamp_ns DESC LIMIT 1")
CYCLES = ("SELECT y.steps, y.low, CAST(sum(y.count) AS BIGINT) " + OF_CHANNEL +
          "JOIN cycles y ON y.run_id = c.run_id AND y.channel = c.channel WHERE " + SAME + " GROUP BY y.steps, y.low")
RESIDUES = ("SELECT s.class " + OF_CHANNEL + "JOIN residues s ON s.run_id = c.run_id AND s.channel = c.channel WHERE " +
            SAME + " ORDER BY r.first_stamp_ns, r.run_key, s.place")
CURVE = ("sn_knee_range", "sn_knee_cycles", "sn_slope", "sn_slope_below", "mean_stress_sensitivity")
TALLY = ("samples", "skipped", "below", "above", "gaps", "minimum", "maximum")


def channel_of(store, machine, row):
    """(channel, identity, S-N data) with the cycles of all runs."""
    same = (machine, *row[:5])
    latest = store.row(LATEST, *same)
    named = dict(zip(("name", "least", "greatest", "classes"), row[1:5]), unit=latest[0], **dict(zip(CURVE, latest[1:])))
    channel = Channel.of(named, row[15])
    channel.hours = float(row[5] or 0.0) / 3600.0
    channel.add_tally({name: None if v is None else v if "imum" in name else int(v)
                       for name, v in zip(TALLY, row[6:13])})
    if row[13] is not None and row[14]:
        channel.add_std(float(row[13]) / float(row[14]), float(row[14]))
    if row[16] is not None and row[18]:
        weight = float(row[18])
        channel.add_range_deviations(float(row[16]) / weight, float(row[17]) / weight, weight)
    channel.count.add_closed(store.rows(CYCLES, *same))
    channel.count.join(point for point, in store.rows(RESIDUES, *same))
    return channel, row[0], latest


def write_sums(store, machine):
    """Recomputes the sums of one machine."""
    for table in ("machine_equivalents", "machine_cycles", "machine_residues"):
        store.execute(f"DELETE FROM {table} WHERE machine_channel IN "
                      "(SELECT machine_channel FROM machine_channels WHERE machine = ?)", machine)
    store.execute("DELETE FROM machine_channels WHERE machine = ?", machine)
    for row in list(store.rows(CHANNELS, machine)):
        write_channel(store, machine, *channel_of(store, machine, row))


def write_channel(store, machine, channel, identity, latest):
    at = (store.row("SELECT max(machine_channel) FROM machine_channels")[0] or 0) + 1
    count, cycles = channel.count, channel.count.ranges_and_means()
    damage = channel.damage(cycles)
    remaining = channel.remaining_hours(damage)[0]
    store.insert("machine_channels",
                 ["machine_channel", "machine", "identity", "name", "unit", "least", "greatest", "classes", "hours",
                  *TALLY, "mean_std", "range_own_std", "range_systematic_std", *CURVE,
                  "equivalent_cycles_per_hour", "largest_range", "damage", "remaining_hours"],
                 [(at, machine, identity, channel.name, channel.unit, *count.grid(), channel.hours,
                   *(getattr(channel, name) for name in TALLY), channel.deviation, *channel.range_deviations,
                   *latest[1:], channel.cycles_per_hour,
                   cycles[-1][0] if cycles else 0.0, damage[0],
                   None if remaining is None or remaining == float("inf") else remaining)])
    store.insert("machine_equivalents", ["machine_channel", "slope", "equivalent_range", "std"],
                 [(at, slope, *figure) for slope, figure in zip(SLOPES, channel.equivalents(cycles))])
    store.insert("machine_cycles", ["machine_channel", "steps", "low", "count"],
                 [(at, steps, low, n) for (steps, low), n in sorted(count.closed.items())])
    store.insert("machine_residues", ["machine_channel", "place", "class"],
                 [(at, place, point) for place, point in enumerate(count.residue)])
