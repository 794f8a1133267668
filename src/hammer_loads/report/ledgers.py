"""The ledger of a machine: the figures that the command life prints."""
from report.channel import Channel

TALLY = ("SELECT sum(counted) AS samples, sum(skipped) AS skipped, sum(below) AS below, sum(above) AS above, "
         "sum(gaps) AS gaps, min(least) AS minimum, max(greatest) AS maximum, sum(deviations) AS deviations, "
         "sum(deviation_sum) AS deviation_sum, sum(range_square) AS range_square, sum(range_own) AS range_own, "
         "sum(range_common) AS range_common FROM tallies WHERE channel = ?")
CYCLES = "SELECT steps, low, sum(count) FROM cycles WHERE channel = ?{} GROUP BY steps, low"
DEVIATION_UNITS = 1024.0  # per class width, in tallies.deviation_sum


class Epoch:
    """Period of work with one hammer, boom and set of grids. `days`: (ids, date, hours, blows), one id for each run of the date."""

    def __init__(self, database, row):
        self.number, self.machine = row["epoch"], row["machine"]
        self.cycles_per_hour = row["equivalent_cycles_per_hour"]
        self.runs = database.value("SELECT count(*) FROM runs WHERE epoch = ?", self.number)
        self.days, self._last_day = [], {}
        for day, date, duration, turns, run in database.rows(
                "SELECT day, date, duration_ns, turns, run FROM days WHERE epoch = ? ORDER BY run, day", self.number):
            if not self.days or self.days[-1][1] != date:
                self.days.append(((), date, 0.0, 0))
            ids, _, hours, blows = self.days[-1]
            self.days[-1] = (ids + (day,), date, hours + duration / 3600e9, blows + turns)
            self._last_day[run] = day
        self.hours = sum(day[2] for day in self.days)
        self.blows = sum(day[3] for day in self.days)
        self._database = database
        self._rows = database.records("SELECT * FROM channels WHERE epoch = ? ORDER BY channel", self.number)

    def channels(self):
        return [self._channel(row) for row in self._rows]

    def channels_of_day(self, day):
        """Channels with the cycles that closed on the day; the residue belongs to the total alone."""
        return [self._channel(row, day) for row in self._rows]

    def _channel(self, row, day=None):
        channel = Channel.of(row, self.cycles_per_hour)
        place, only = (row["channel"],), ""
        if day is not None:
            place += day[0]
            only = f" AND day IN ({', '.join('?' * len(day[0]))})"
        tally = self._database.records(TALLY + only, *place)[0]
        channel.add_tally(tally)
        if tally["deviations"]:
            unit = channel.count.width / DEVIATION_UNITS
            channel.add_std(tally["deviation_sum"] / tally["deviations"] * unit, tally["deviations"])
        if tally["range_square"]:
            channel.add_range_deviations(tally["range_own"] / tally["range_square"],
                                         tally["range_common"] / tally["range_square"], tally["range_square"])
        channel.count.add_closed(self._database.rows(CYCLES.format(only), *place))
        channel.hours = self.hours if day is None else day[2]
        self._join_residues(row, day, channel)
        return channel

    def _join_residues(self, row, day, channel):
        """Run by run; what one closes belongs to its last day."""
        residues = {}
        for run, level in self._database.rows(
                "SELECT run, class FROM residues WHERE channel = ? ORDER BY run, place", row["channel"]):
            residues.setdefault(run, []).append(level)
        if day is None:
            for residue in residues.values():
                channel.count.join(residue)
            return
        joined = Channel.of(row, self.cycles_per_hour).count
        for run, residue in residues.items():
            before = dict(joined.closed)
            joined.join(residue)
            if self._last_day.get(run) in day[0]:
                channel.count.add_closed([(b, a, n - before.get((b, a), 0)) for (b, a), n in joined.closed.items()
                                          if n > before.get((b, a), 0)])


def epochs_of(database):
    return [Epoch(database, row) for row in database.records("SELECT * FROM epochs ORDER BY epoch")]
