"""The ledger of a machine: the figures that the command life prints."""
from report.channel import Channel

TALLY = ("SELECT sum(counted) AS samples, sum(skipped) AS skipped, sum(below) AS below, sum(above) AS above, "
         "sum(gaps) AS gaps, min(least) AS minimum, max(greatest) AS maximum, sum(deviations) AS deviations, "
         "sum(deviation_sum) AS deviation_sum FROM tallies WHERE channel = ?")
CYCLES = "SELECT steps, low, sum(count) FROM cycles WHERE channel = ?{} GROUP BY steps, low"
DEVIATION_UNITS = 1024.0  # per class width, in tallies.deviation_sum


class Epoch:
    """Same hammer, boom and grids. `days`: (day, date, hours, blows)."""

    def __init__(self, database, row):
        self.number, self.machine = row["epoch"], row["machine"]
        self.cycles_per_hour = row["equivalent_cycles_per_hour"]
        self.runs = database.value("SELECT count(*) FROM runs WHERE epoch = ?", self.number)
        self.days = [(day, date, duration / 3600e9, turns) for day, date, duration, turns in database.rows(
            "SELECT day, date, duration_ns, turns FROM days WHERE epoch = ? ORDER BY day", self.number)]
        self.hours = sum(day[2] for day in self.days)
        self.blows = sum(day[3] for day in self.days)
        self._database = database
        self._rows = database.records("SELECT * FROM channels WHERE epoch = ? ORDER BY channel", self.number)

    def channels(self):
        return [self._channel(row) for row in self._rows]

    def channels_of_day(self, day):
        """Of the cycles that closed on the day; the residue belongs to the total alone."""
        return [self._channel(row, day) for row in self._rows]

    def _channel(self, row, day=None):
        channel = Channel.of(row, self.cycles_per_hour)
        place = (row["channel"],) if day is None else (row["channel"], day[0])
        only = "" if day is None else " AND day = ?"
        tally = self._database.records(TALLY + only, *place)[0]
        channel.add_tally(tally)
        if tally["deviations"]:
            unit = channel.count.width / DEVIATION_UNITS
            channel.add_deviation(tally["deviation_sum"] / tally["deviations"] * unit, tally["deviations"])
        channel.count.add_closed(self._database.rows(CYCLES.format(only), *place))
        channel.hours = self.hours if day is None else day[2]
        for is_open in (0, 1) if day is None else ():
            channel.count.join([c for c, in self._database.rows(
                "SELECT class FROM residues WHERE channel = ? AND open = ? ORDER BY place", row["channel"], is_open)])
        return channel


def epochs_of(database):
    return [Epoch(database, row) for row in database.records("SELECT * FROM epochs ORDER BY epoch")]
