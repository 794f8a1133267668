"""A machine's ledger: months of work, by epoch and by day."""
from report.cycle_figures import channel_pictures, equivalents_table, explanation, with_deviation
from report.damage import SLOPES
from report.ledgers import epochs_of
from report.costs import back_calculation, damage_of, judged_channel, rule_of, shares_table
from report.markup import Raw, block, details, in_unit, number, paragraph, table
from report.names import without_unit


def days_table(epoch):
    """Of every channel the damage-equivalent range at slope 5 and the damage, by day."""
    at = SLOPES.index(5.0)
    rows, header = [], ["Day (UTC)", "Hours", "Blows"]
    for day in epoch.days:
        row = [day[1], number(day[2]), number(day[3])]
        for channel in epoch.channels_of_day(day):
            factor, unit = in_unit(channel.unit)
            cycles = channel.count.ranges_and_means()
            row.append(with_deviation(channel.equivalents(cycles)[at], factor))
            if len(header) < len(row):
                header.append(f"{without_unit(channel.name)} [{unit}], slope 5")
            if channel.curve is not None:
                row.append(with_deviation(channel.damage(cycles)))
                if len(header) < len(row):
                    header.append(f"{without_unit(channel.name)}, damage")
        rows.append(row)
    return table("By the day on which a cycle closed", header, rows)


def days_shares(epoch, channels):
    judged = judged_channel(channels)
    at = channels.index(judged)
    groups = [(day[1], day[3], damage_of(judged, epoch.channels_of_day(day)[at].count.ranges_and_means()))
              for day in epoch.days]
    return shares_table(f"Share of the damage by day: {without_unit(judged.name)}, {rule_of(judged)}", "Day (UTC)", "Blows",
                        groups)


def epoch_content(epoch):
    channels = epoch.channels()
    content = paragraph(f"Epoch {epoch.number}: {number(epoch.hours)} hours, "
                        f"{epoch.blows} blows, {epoch.runs} runs.")
    if not channels or not epoch.days:
        return content + paragraph("Nothing was counted yet.")
    pictures = "".join(channel_pictures(channel) for channel in channels)
    return (content + explanation(channels) + equivalents_table(channels) + days_table(epoch) +
            days_shares(epoch, channels) + block("Another load, another life", back_calculation(channels)) +
            details("Pictures of the cycles", pictures))


def ledger_content(database):
    epochs = epochs_of(database)
    if not epochs:
        return paragraph("The ledger holds no epoch yet.")
    return Raw("".join(epoch_content(epoch) for epoch in epochs))
