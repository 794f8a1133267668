/// life: damage and remaining life of a machine by its ledger.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/ledger_reader.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

using life::ChannelReport;
using life::EpochReport;
using life::Figure;
using life::PeriodFigures;
using Row = std::vector<std::string>;

std::string slopeName(std::size_t i) { return shortNumber(life::kSlopes[i]); }

/// Names and figures that have standard deviations, in the order of the columns.
std::vector<std::pair<std::string, std::optional<Figure>>> named(const life::ChannelFigures& figures) {
  std::vector<std::pair<std::string, std::optional<Figure>>> all;
  for (std::size_t i = 0; i < life::kSlopeCount; ++i)
    all.emplace_back("equivalent_range_" + slopeName(i), figures.equivalent_range[i]);
  all.emplace_back("damage", figures.damage);
  all.emplace_back("remaining_hours", figures.remaining_hours);
  return all;
}

// --- Text ---------------------------------------------------------------------------------------------------------

std::string number(double value) { return std::isnan(value) ? "-" : format("%.5g", value); }

std::string withDeviation(const std::optional<Figure>& figure) {
  if (!figure) return "-";
  return number(figure->value) + (std::isnan(figure->deviation) ? "" : format(" +- %.2g", figure->deviation));
}

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

Row figureTitles(Row titles) {
  titles.insert(titles.end(), {"hours", "blows"});
  for (std::size_t i = 0; i < life::kSlopeCount; ++i) titles.push_back("range m=" + slopeName(i));
  titles.insert(titles.end(), {"largest", "damage"});
  return titles;
}

Row figureCells(Row cells, const PeriodFigures& period) {
  cells.insert(cells.end(), {number(period.hours), std::to_string(period.blows)});
  for (const Figure& range : period.figures.equivalent_range) cells.push_back(withDeviation(range));
  cells.insert(cells.end(), {number(period.figures.largest_range), withDeviation(period.figures.damage)});
  return cells;
}

std::string channelTable(const std::vector<ChannelReport>& channels) {
  Row titles = figureTitles({"channel", "unit"});
  titles.insert(titles.end(), {"hours left", "saturated", "skipped", "gaps"});
  std::vector<Row> rows{titles};
  for (const ChannelReport& c : channels) {
    const PeriodFigures& all = c.periods.front();
    Row row = figureCells({c.name, c.unit}, all);
    row.insert(row.end(), {withDeviation(all.figures.remaining_hours), std::to_string(c.tally.below + c.tally.above),
                           std::to_string(c.tally.skipped), std::to_string(c.tally.gaps)});
    rows.push_back(row);
  }
  return aligned(rows);
}

std::string dayTable(const ChannelReport& channel) {
  std::vector<Row> rows{figureTitles({"day"})};
  for (std::size_t i = 1; i < channel.periods.size(); ++i)
    rows.push_back(figureCells({channel.periods[i].day}, channel.periods[i]));
  return channel.name + " [" + channel.unit + "], by the day on which a cycle closed (UTC)\n" + aligned(rows);
}

std::string epochText(const EpochReport& report) {
  std::string text = format("epoch %lld: machine %s, %llu runs\n", static_cast<long long>(report.epoch.id),
                            report.epoch.machine.identity.c_str(), static_cast<unsigned long long>(report.epoch.runs));
  text += "Damage-equivalent loads are ranges at " + shortNumber(report.epoch.machine.equivalent_cycles_per_hour) +
          " cycles an hour; cycles of ASTM E1049, the residue as half cycles.\n";
  text += channelTable(report.channels);
  for (const ChannelReport& channel : report.channels) text += '\n' + dayTable(channel);
  return text;
}

// --- CSV ----------------------------------------------------------------------------------------------------------

std::string cell(double value) { return std::isnan(value) ? "" : shortNumber(value); }

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + '"';
}

std::string csvHeader() {
  std::string header = "epoch,channel,unit,day,hours,blows,cycles,largest_range";
  for (const auto& [name, figure] : named({})) header += ',' + name + ',' + name + "_std," + name + "_systematic_std";
  return header + ",below,above,skipped,gaps\n";
}

std::string csvLines(std::int64_t epoch, const ChannelReport& c) {
  std::string lines;
  for (const PeriodFigures& p : c.periods) {
    lines += std::to_string(epoch) + ',' + quoted(c.name) + ',' + quoted(c.unit) + ',' + p.day + ',' + cell(p.hours) +
             ',' + std::to_string(p.blows) + ',' + cell(p.figures.cycles) + ',' + cell(p.figures.largest_range);
    for (const auto& [name, figure] : named(p.figures))
      lines += figure ? ',' + cell(figure->value) + ',' + cell(figure->deviation) + ',' + cell(figure->common) : ",,,";
    for (const std::uint64_t count : {c.tally.below, c.tally.above, c.tally.skipped, c.tally.gaps})
      lines += ',' + (&p == c.periods.data() ? std::to_string(count) : "");  // known of all days together
    lines += '\n';
  }
  return lines;
}

// --- JSON ---------------------------------------------------------------------------------------------------------

using Json = nlohmann::json;

/// Keys are sorted by name; null is written for what is no finite number.
Json json(const PeriodFigures& p) {
  Json object{
      {"hours", p.hours}, {"blows", p.blows}, {"cycles", p.figures.cycles}, {"largest_range", p.figures.largest_range}};
  for (const auto& [name, figure] : named(p.figures)) {
    object[name] = nullptr;
    if (figure)
      object[name] = {{"value", figure->value}, {"std", figure->deviation}, {"systematic_std", figure->common}};
  }
  return object;
}

Json json(const ChannelReport& c) {
  Json object = json(c.periods.front());
  object.update({{"channel", c.name},
                 {"unit", c.unit},
                 {"least", c.extremes.least},
                 {"greatest", c.extremes.greatest},
                 {"samples", c.tally.counted},
                 {"below", c.tally.below},
                 {"above", c.tally.above},
                 {"skipped", c.tally.skipped},
                 {"gaps", c.tally.gaps},
                 {"days", Json::array()}});
  for (std::size_t i = 1; i < c.periods.size(); ++i) {
    object["days"].push_back(json(c.periods[i]));
    object["days"].back()["day"] = c.periods[i].day;
  }
  return object;
}

/// For reading: a table of channels per epoch, then the days of each channel.
std::string lifeText(const std::vector<EpochReport>& epochs) {
  std::string text;
  for (const EpochReport& epoch : epochs) text += (text.empty() ? "" : "\n") + epochText(epoch);
  return text;
}

/// One line per epoch, channel and day, the totals with day `all`; a figure that does not exist is an empty cell.
std::string lifeCsv(const std::vector<EpochReport>& epochs) {
  std::string text = csvHeader();
  for (const EpochReport& epoch : epochs) {
    for (const ChannelReport& channel : epoch.channels) text += csvLines(epoch.epoch.id, channel);
  }
  return text;
}

/// Report as one JSON object; a figure that does not exist is null.
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

constexpr char kNotes[] =
    "Per epoch (machine, boom and grid) and channel: hours, blows, damage-equivalent load ranges, largest range, and "
    "with\n"
    "an S-N curve damage and hours until it is 1 at the rate so far; then the same by day. A run may write meanwhile.";

int run(int argc, const char* const* argv) {
  CommandLine line("Life of a machine from its ledger", "life", kNotes);
  std::string file;
  std::string remove;
  bool as_json = false, as_csv = false, list_runs = false;
  line.add_option("ledger", file, "file that the node or process_bag --ledger wrote")
      ->required()
      ->type_name("LEDGER.sqlite");
  CLI::Option* json = line.add_flag("--json", as_json, "as JSON");
  CLI::Option* csv = line.add_flag("--csv", as_csv, "as CSV")->excludes(json);
  CLI::Option* runs = line.add_flag("--runs", list_runs, "the runs that it counts, as CSV")->excludes(json, csv);
  line.add_option("--remove", remove, "take this run out of the ledger")->type_name("RUN")->excludes(json, csv, runs);
  if (const auto code = line.parse(argc, argv)) return *code;
  if (!remove.empty()) {
    const std::optional<std::string> problem = life::removeFromLedger(file, remove);
    return problem ? fail({*problem}) : 0;
  }

  Checked<life::LedgerReader> reader = life::LedgerReader::open(file);
  if (!reader.value) return fail(reader.problems);
  if (list_runs) {
    std::cout << "run,epoch,crank_messages,blows\n";
    for (const life::LedgerRunInfo& r : reader.value->runs())
      std::cout << r.name << ',' << r.epoch << ',' << r.messages << ',' << r.turns << '\n';
    return reader.value->problem().empty() ? finishOutput() : fail({reader.value->problem()});
  }
  const Checked<std::vector<EpochReport>> report = life::lifeReport(*reader.value);
  if (!report.value) return fail(report.problems);
  std::cout << (as_json ? lifeJson(*report.value) : as_csv ? lifeCsv(*report.value) : lifeText(*report.value));
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
