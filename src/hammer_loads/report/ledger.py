"""The ledger of a machine, months of work by epoch and by day: the figures that the command life prints."""
from report.blocks import Table
from report.costs import back_calculation, damage_of, judged_channel, rule_of, shares_table
from report.cycle_figures import cycle_figures
from report.cycles import Channel, Count
from report.formats import in_unit, in_words, measured, number, titled

# Of some days; tallies.deviation_sum counts 1024 for the width of a class.
CHANNELS = """SELECT c.*, equivalent_cycles_per_hour, sum(skipped) AS skipped, sum(below) AS below, sum(above) AS above,
    sum(gaps) AS gaps, sum(deviation_sum) * (c.greatest - c.least) / c.classes / 1024 / nullif(sum(deviations), 0) AS mean_std,
    sum(range_own) * 1.0 / nullif(sum(range_square), 0) AS range_own_std,
    sum(range_common) * 1.0 / nullif(sum(range_square), 0) AS range_systematic_std
    FROM channels c JOIN epochs USING(epoch) LEFT JOIN tallies t ON t.channel = c.channel AND day IN ({0})
    WHERE epoch = ? GROUP BY c.channel ORDER BY c.channel"""
CYCLES = "SELECT steps, low, sum(count) FROM cycles WHERE channel = ? AND day IN ({0}) GROUP BY steps, low"


class Epoch:
    """Period of work with one hammer, boom and set of grids. days: rows of the table for each run and date, in their order."""

    def __init__(self, database, number):
        self.database, self.number = database, number
        self.days = database.frame("SELECT day, run, date, duration_ns / 3600e9 AS hours, turns AS blows FROM days "
                                   "WHERE epoch = ? ORDER BY run, day", number)
        self.runs = database.value("SELECT count(*) FROM runs WHERE epoch = ?", number)
        self.hours, self.blows = self.days.hours.sum(), int(self.days.blows.sum())

    def by_date(self):
        """(date, its days)."""
        return self.days.groupby("date")

    def channels(self, days=None):
        """Channels with the cycles that closed on these days; over all of them (None) with the residue, which is of no day."""
        shown = self.days if days is None else days
        listed = ", ".join(map(str, shown.day))
        for row in self.database.records(CHANNELS.format(listed), self.number):
            closed = self.database.rows(CYCLES.format(listed), row["channel"])
            channel = Channel({**row, "hours": shown.hours.sum()}, closed, ())
            total, last_day = Count(*channel.count.grid), self.days.groupby("run").day.last()
            points = self.database.frame("SELECT run, class FROM residues WHERE channel = ? ORDER BY run, place", row["channel"])
            for run, residue in points.groupby("run")["class"]:
                across = total.join(residue)  # belongs to the last day of the run
                if last_day.get(run) in shown.day.values:
                    channel.count.add_closed(across)
            if days is None:
                channel.count.residue = total.residue
            yield channel


def days_table(epoch, channels_by_day):
    """Damage-equivalent range at slope 5 and damage of each channel, by day."""
    header, rows = ["Day (UTC)", "Hours", "Blows"], []
    for channel in epoch.channels():
        name = in_words(channel.name)
        header.append(titled(name, in_unit(channel.unit)[1]) + ", slope 5")
        header += [f"{name}, damage"] if channel.curve is not None else []
    for (date, days), channels in zip(epoch.by_date(), channels_by_day):
        row = [date, days.hours.sum(), int(days.blows.sum())]
        for channel in channels:
            row.append(measured(*channel.equivalents()[5.0], in_unit(channel.unit)[0]))
            row += [measured(*channel.damage())] if channel.curve is not None else []
        rows.append(row)
    return Table("By the day on which a cycle closed", header, rows)


def epoch_blocks(epoch):
    title = f"Epoch {epoch.number}: {number(epoch.hours)} hours, {number(epoch.blows)} blows, {epoch.runs} runs."
    channels = list(epoch.channels())
    if not channels or epoch.days.empty:
        return [title, "Nothing was counted yet."]
    channels_by_day = [list(epoch.channels(days)) for _, days in epoch.by_date()]
    judged = judged_channel(channels)
    at = channels.index(judged)
    shares = shares_table(f"Share of the damage by day: {rule_of(judged)}", "Day (UTC)", "Blows",
                          [(date, days.blows.sum(), damage_of(of_day[at]))
                           for (date, days), of_day in zip(epoch.by_date(), channels_by_day)])
    return [title, *cycle_figures(channels), days_table(epoch, channels_by_day), shares, back_calculation(channels)]


def epochs_of(database):
    return [Epoch(database, number) for number, in database.rows("SELECT epoch FROM epochs ORDER BY epoch")]


def ledger_blocks(database):
    return [block for epoch in epochs_of(database) for block in epoch_blocks(epoch)] or ["The ledger holds no epoch yet."]
