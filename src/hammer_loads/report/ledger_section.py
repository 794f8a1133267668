"""A machine's ledger: months of work, by epoch and by day."""
from report.cycle_figures import channel_pictures, equivalents_table, explanation, with_deviation
from report.damage import SLOPES
from report.ledgers import epochs_of
from report.markup import Raw, details, in_unit, number, paragraph, table


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
                header.append(f"{channel.name} [{unit}], slope 5")
            if channel.curve is not None:
                row.append(with_deviation(channel.damage(cycles)))
                if len(header) < len(row):
                    header.append(f"{channel.name}, damage")
        rows.append(row)
    return table("By the day on which a cycle closed", header, rows)


def epoch_content(epoch):
    channels = epoch.channels()
    content = paragraph(f"Epoch {epoch.number}, machine {epoch.machine[:12]}: {number(epoch.hours)} hours, "
                        f"{epoch.blows} blows, {epoch.runs} runs.")
    if not channels or not epoch.days:
        return content + paragraph("Nothing was counted yet.")
    pictures = "".join(channel_pictures(channel) for channel in channels)
    return (content + explanation(channels) + equivalents_table(channels) + days_table(epoch) +
            details("Pictures of the cycles", pictures))


def ledger_content(database):
    epochs = epochs_of(database)
    if not epochs:
        return paragraph("The ledger holds no epoch yet.")
    return Raw("".join(epoch_content(epoch) for epoch in epochs))
