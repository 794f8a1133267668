#include "hammer_loads/commands/life_tables.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hammer_loads/life/count_csv.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

using life::ChannelFigures;
using life::ChannelReport;
using life::DayFigures;
using life::EpochReport;
using life::Figure;

std::string slopeName(std::size_t i) { return life::shortNumber(life::kSlopes[i]); }

// --- Text ---------------------------------------------------------------------------------------------------------

using Row = std::vector<std::string>;

std::string number(double value) { return std::isnan(value) ? "-" : format("%.5g", value); }

std::string withDeviation(const Figure& figure) {
  return number(figure.value) + (std::isnan(figure.deviation) ? "" : format(" +- %.2g", figure.deviation));
}

std::string withDeviation(const std::optional<Figure>& figure) { return figure ? withDeviation(*figure) : "-"; }

/// Columns aligned, the first to the left.
std::string aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string gap(widths[i] - row[i].size(), ' ');
      text += i == 0 ? row[i] + gap : "  " + gap + row[i];
    }
    text += '\n';
  }
  return text;
}

Row figureTitles() {
  Row titles{"hours", "blows"};
  for (std::size_t i = 0; i < life::kSlopeCount; ++i) titles.push_back("range m=" + slopeName(i));
  titles.insert(titles.end(), {"largest", "damage"});
  return titles;
}

Row figureCells(double hours, std::uint64_t blows, const ChannelFigures& figures) {
  Row cells{number(hours), std::to_string(blows)};
  for (const Figure& range : figures.equivalent_range) cells.push_back(withDeviation(range));
  cells.push_back(number(figures.largest_range));
  cells.push_back(withDeviation(figures.damage));
  return cells;
}

Row joined(Row first, const Row& rest) {
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

std::string channelTable(const std::vector<ChannelReport>& channels) {
  Row titles = joined({"channel", "unit"}, figureTitles());
  titles.insert(titles.end(), {"hours left", "saturated", "skipped", "gaps"});
  std::vector<Row> rows{titles};
  for (const ChannelReport& c : channels) {
    Row row = joined({c.name, c.unit}, figureCells(c.hours, c.blows, c.figures));
    row.push_back(withDeviation(c.figures.remaining_hours));
    row.push_back(std::to_string(c.tally.below + c.tally.above));
    row.push_back(std::to_string(c.tally.skipped));
    row.push_back(std::to_string(c.tally.gaps));
    rows.push_back(row);
  }
  return aligned(rows);
}

std::string dayTable(const ChannelReport& channel) {
  std::vector<Row> rows{joined({"day"}, figureTitles())};
  for (const DayFigures& day : channel.days)
    rows.push_back(joined({day.date}, figureCells(day.hours, day.blows, day.figures)));
  return channel.name + " [" + channel.unit + "], by the day on which a cycle closed (UTC)\n" + aligned(rows);
}

std::string epochText(const EpochReport& report) {
  std::string text = format("epoch %lld: machine %s, %llu runs\n", static_cast<long long>(report.epoch.id),
                            report.epoch.machine.identity.c_str(), static_cast<unsigned long long>(report.epoch.runs));
  text += "Damage-equivalent loads are ranges at " +
          life::shortNumber(report.epoch.machine.equivalent_cycles_per_hour) +
          " cycles an hour; cycles of ASTM E1049, the residue as half cycles.\n";
  text += channelTable(report.channels);
  for (const ChannelReport& channel : report.channels) text += '\n' + dayTable(channel);
  return text;
}

// --- CSV ----------------------------------------------------------------------------------------------------------

std::string cell(double value) { return std::isnan(value) ? "" : life::shortNumber(value); }

std::string cells(const std::optional<Figure>& figure) {
  return figure ? ',' + cell(figure->value) + ',' + cell(figure->deviation) + ',' + cell(figure->common) : ",,,";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + '"';
}

std::string csvFigures(double hours, std::uint64_t blows, const ChannelFigures& f) {
  std::string line = cell(hours) + ',' + std::to_string(blows) + ',' + cell(f.cycles) + ',' + cell(f.largest_range);
  for (const Figure& range : f.equivalent_range) line += cells(range);
  return line + cells(f.damage) + cells(f.remaining_hours);
}

std::string csvHeader() {
  std::string header = "epoch,channel,unit,day,hours,blows,cycles,largest_range";
  const auto figure = [&](const std::string& name) {
    header += ',' + name + ',' + name + "_std," + name + "_systematic_std";
  };
  for (std::size_t i = 0; i < life::kSlopeCount; ++i) figure("equivalent_range_" + slopeName(i));
  figure("damage");
  figure("remaining_hours");
  return header + ",below,above,skipped,gaps\n";
}

std::string csvLines(std::int64_t epoch, const ChannelReport& c) {
  const std::string begin = std::to_string(epoch) + ',' + quoted(c.name) + ',' + quoted(c.unit) + ',';
  std::string lines = begin + "all," + csvFigures(c.hours, c.blows, c.figures);
  for (const std::uint64_t count : {c.tally.below, c.tally.above, c.tally.skipped, c.tally.gaps})
    lines += ',' + std::to_string(count);
  lines += '\n';
  for (const DayFigures& day : c.days)
    lines += begin + day.date + ',' + csvFigures(day.hours, day.blows, day.figures) + ",,,,\n";
  return lines;
}

// --- JSON ---------------------------------------------------------------------------------------------------------

using Json = nlohmann::json;

/// Keys are sorted by name; null is written for what is no finite number.
Json json(const Figure& figure) {
  return {{"value", figure.value}, {"std", figure.deviation}, {"systematic_std", figure.common}};
}
Json json(const std::optional<Figure>& figure) { return figure ? json(*figure) : Json(nullptr); }

Json json(double hours, std::uint64_t blows, const ChannelFigures& f) {
  Json object{{"hours", hours}, {"blows", blows}, {"cycles", f.cycles}, {"largest_range", f.largest_range}};
  for (std::size_t i = 0; i < life::kSlopeCount; ++i)
    object["equivalent_range_" + slopeName(i)] = json(f.equivalent_range[i]);
  object["damage"] = json(f.damage);
  object["remaining_hours"] = json(f.remaining_hours);
  return object;
}

Json json(const ChannelReport& c) {
  Json object{{"channel", c.name}, {"unit", c.unit}};
  object.update(json(c.hours, c.blows, c.figures));
  object["least"] = c.extremes.least;
  object["greatest"] = c.extremes.greatest;
  object["samples"] = c.tally.counted;
  object["below"] = c.tally.below;
  object["above"] = c.tally.above;
  object["skipped"] = c.tally.skipped;
  object["gaps"] = c.tally.gaps;
  object["days"] = Json::array();
  for (const DayFigures& day : c.days) {
    Json entry{{"day", day.date}};
    entry.update(json(day.hours, day.blows, day.figures));
    object["days"].push_back(entry);
  }
  return object;
}

}  // namespace

std::string lifeText(const std::vector<EpochReport>& epochs) {
  std::string text;
  for (const EpochReport& epoch : epochs) text += (text.empty() ? "" : "\n") + epochText(epoch);
  return text;
}

std::string lifeCsv(const std::vector<EpochReport>& epochs) {
  std::string text = csvHeader();
  for (const EpochReport& epoch : epochs) {
    for (const ChannelReport& channel : epoch.channels) text += csvLines(epoch.epoch.id, channel);
  }
  return text;
}

std::string lifeJson(const std::vector<EpochReport>& epochs) {
  Json list = Json::array();
  for (const EpochReport& report : epochs) {
    Json entry{
        {"epoch", report.epoch.id},  {"machine", report.epoch.machine.identity},
        {"runs", report.epoch.runs}, {"equivalent_cycles_per_hour", report.epoch.machine.equivalent_cycles_per_hour},
        {"residue", "half cycles"},  {"channels", Json::array()}};
    for (const ChannelReport& channel : report.channels) entry["channels"].push_back(json(channel));
    list.push_back(entry);
  }
  return Json{{"epochs", list}}.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace hammer_loads
