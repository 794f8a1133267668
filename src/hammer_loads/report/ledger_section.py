"""A machine's ledger: months of work, by epoch and by day."""
from report.costs import back_calculation, damage_of, judged_channel, rule_of, shares_table
from report.cycle_figures import cycle_figures, with_std
from report.damage import SLOPES
from report.formats import Table, in_unit, titled
from report.ledgers import epochs_of
from report.names import in_words


def days_table(epoch, channels_by_day):
    """Damage-equivalent range at slope 5 and damage of each channel, by day."""
    header, rows = ["Day (UTC)", "Hours", "Blows"], []
    for channel in epoch.channels():
        name = in_words(channel.name)
        header.append(titled(name, in_unit(channel.unit)[1]) + ", slope 5")
        header += [f"{name}, damage"] if channel.curve is not None else []
    for (_, date, hours, blows), channels in zip(epoch.days, channels_by_day):
        row = [date, hours, blows]
        for channel in channels:
            row.append(with_std(channel.equivalents()[SLOPES.index(5.0)], in_unit(channel.unit)[0]))
            row += [with_std(channel.damage())] if channel.curve is not None else []
        rows.append(row)
    return Table("By the day on which a cycle closed", header, rows)


def epoch_content(epoch):
    channels = epoch.channels()
    content = {"epoch": epoch, "cycles": None}
    if not channels or not epoch.days:
        return content
    channels_by_day = [epoch.channels_of_day(day) for day in epoch.days]
    judged = judged_channel(channels)
    shares = shares_table(f"Share of the damage by day: {rule_of(judged)}", "Day (UTC)", "Blows",
                          [(date, blows, damage_of(of_day[channels.index(judged)]))
                           for (_, date, _, blows), of_day in zip(epoch.days, channels_by_day)])
    return {**content, "cycles": cycle_figures(channels), "days": days_table(epoch, channels_by_day), "shares": shares,
            "life": back_calculation(channels)}


def ledger_section(database):
    return [epoch_content(epoch) for epoch in epochs_of(database)]
