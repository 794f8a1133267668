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
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

using life::CycleCount;
using life::Figure;
using life::LedgerDay;
using life::LedgerEpoch;
using Json = nlohmann::json;
using Row = std::vector<std::string>;

std::string slopeName(double slope) { return "equivalent_range_" + shortNumber(slope); }

/// Names of the figures that have standard deviations, in the order of the columns.
std::vector<std::string> figureNames() {
  std::vector<std::string> names;
  for (const double slope : life::kSlopes) names.push_back(slopeName(slope));
  names.insert(names.end(), {"damage", "remaining_hours"});
  return names;
}

// --- Report: the object that --json writes. The other formats show parts of it. -----------------------------------

Json figureJson(const std::optional<Figure>& figure) {
  if (!figure) return nullptr;
  return {{"value", figure->value}, {"std", figure->deviation}, {"systematic_std", figure->common}};
}

Json periodJson(const LedgerEpoch& epoch, const life::CountedChannel& channel, const LedgerDay& period,
                const CycleCount& count) {
  constexpr double kNsPerHour = 3600e9;
  const double hours = static_cast<double>(period.duration) / kNsPerHour;
  const life::ChannelFigures figures = life::figuresOf(count, channel, hours, epoch.machine.equivalent_cycles_per_hour);
  Json object{{"hours", hours},
              {"blows", period.turns},
              {"cycles", figures.cycles},
              {"largest_range", figures.largest_range},
              {"damage", figureJson(figures.damage)},
              {"remaining_hours", figureJson(figures.remaining_hours)}};
  for (std::size_t i = 0; i < life::kSlopeCount; ++i)
    object[slopeName(life::kSlopes[i])] = figureJson(figures.equivalent_range[i]);
  return object;
}

/// The whole epoch, and in `days` each day with the cycles that closed on it.
Json channelJson(life::LedgerReader& reader, const LedgerEpoch& epoch, const life::CountedChannel& channel) {
  const life::LedgerCounts counts = reader.counts(epoch, channel);
  LedgerDay all;
  for (const LedgerDay& day : epoch.days) all.duration += day.duration, all.turns += day.turns;
  Json object = periodJson(epoch, channel, all, counts.total);
  object.update({{"channel", channel.name},
                 {"unit", life::unitOf(channel.name)},
                 {"least", counts.total.extremes.least},
                 {"greatest", counts.total.extremes.greatest},
                 {"samples", counts.total.tally.counted},
                 {"below", counts.total.tally.below},
                 {"above", counts.total.tally.above},
                 {"skipped", counts.total.tally.skipped},
                 {"gaps", counts.total.tally.gaps},
                 {"days", Json::array()}});
  for (std::size_t i = 0; i < epoch.days.size(); ++i) {
    object["days"].push_back(periodJson(epoch, channel, epoch.days[i], counts.days[i]));
    object["days"].back()["day"] = epoch.days[i].date;
  }
  return object;
}

/// Every epoch of the ledger; a figure that does not exist is null or not a number.
Json reportJson(life::LedgerReader& reader) {
  Json epochs = Json::array();
  for (const LedgerEpoch& epoch : reader.epochs()) {
    Json entry{{"epoch", epoch.id},        {"machine", epoch.machine.identity},
               {"runs", epoch.runs},       {"equivalent_cycles_per_hour", epoch.machine.equivalent_cycles_per_hour},
               {"residue", "half cycles"}, {"channels", Json::array()}};
    for (const life::CountedChannel& channel : epoch.machine.channels)
      entry["channels"].push_back(channelJson(reader, epoch, channel));
    epochs.push_back(std::move(entry));
  }
  return epochs;
}

// --- Text ---------------------------------------------------------------------------------------------------------

std::string number(double value) { return std::isnan(value) ? "-" : format("%.5g", value); }

std::string withDeviation(const Json& figure) {
  if (figure.is_null()) return "-";
  const double deviation = figure["std"];
  return number(figure["value"]) + (std::isnan(deviation) ? "" : format(" +- %.2g", deviation));
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
  for (const double slope : life::kSlopes) titles.push_back("range m=" + shortNumber(slope));
  titles.insert(titles.end(), {"largest", "damage"});
  return titles;
}

Row figureCells(Row cells, const Json& period) {
  cells.insert(cells.end(), {number(period["hours"]), period["blows"].dump()});
  for (const double slope : life::kSlopes) cells.push_back(withDeviation(period[slopeName(slope)]));
  cells.insert(cells.end(), {number(period["largest_range"]), withDeviation(period["damage"])});
  return cells;
}

std::string channelTable(const Json& channels) {
  Row titles = figureTitles({"channel", "unit"});
  titles.insert(titles.end(), {"hours left", "saturated", "skipped", "gaps"});
  std::vector<Row> rows{titles};
  for (const Json& c : channels) {
    Row row = figureCells({c["channel"], c["unit"]}, c);
    row.insert(row.end(), {withDeviation(c["remaining_hours"]),
                           std::to_string(c["below"].get<std::uint64_t>() + c["above"].get<std::uint64_t>()),
                           c["skipped"].dump(), c["gaps"].dump()});
    rows.push_back(row);
  }
  return aligned(rows);
}

std::string dayTable(const Json& channel) {
  std::vector<Row> rows{figureTitles({"day"})};
  for (const Json& day : channel["days"]) rows.push_back(figureCells({day["day"]}, day));
  return channel["channel"].get<std::string>() + " [" + channel["unit"].get<std::string>() +
         "], by the day on which a cycle closed (UTC)\n" + aligned(rows);
}

/// For reading: a table of channels per epoch, then the days of each channel.
std::string lifeText(const Json& epochs) {
  std::string text;
  for (const Json& epoch : epochs) {
    if (!text.empty()) text += '\n';
    text += "epoch " + epoch["epoch"].dump() + ": machine " + epoch["machine"].get<std::string>() + ", " +
            epoch["runs"].dump() + " runs\n";
    text += "Damage-equivalent loads are ranges at " + shortNumber(epoch["equivalent_cycles_per_hour"]) +
            " cycles an hour; cycles of ASTM E1049, the residue as half cycles.\n";
    text += channelTable(epoch["channels"]);
    for (const Json& channel : epoch["channels"]) text += '\n' + dayTable(channel);
  }
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
  for (const std::string& name : figureNames()) header += ',' + name + ',' + name + "_std," + name + "_systematic_std";
  return header + ",below,above,skipped,gaps\n";
}

std::string csvLine(const Json& epoch, const Json& channel, const Json& period) {
  std::string line = epoch["epoch"].dump() + ',' + quoted(channel["channel"]) + ',' + quoted(channel["unit"]) + ',' +
                     period.value("day", "all") + ',' + cell(period["hours"]) + ',' + period["blows"].dump() + ',' +
                     cell(period["cycles"]) + ',' + cell(period["largest_range"]);
  for (const std::string& name : figureNames())
    for (const char* part : {"value", "std", "systematic_std"})
      line += ',' + (period[name].is_null() ? "" : cell(period[name][part]));
  for (const char* name : {"below", "above", "skipped", "gaps"})
    line += ',' + (period.contains(name) ? period[name].dump() : "");  // known of all days together
  return line + '\n';
}

/// One line per epoch, channel and day, the totals with day `all`; a figure that does not exist is an empty cell.
std::string lifeCsv(const Json& epochs) {
  std::string text = csvHeader();
  for (const Json& epoch : epochs) {
    for (const Json& channel : epoch["channels"]) {
      text += csvLine(epoch, channel, channel);
      for (const Json& day : channel["days"]) text += csvLine(epoch, channel, day);
    }
  }
  return text;
}

/// null is written for what is no finite number.
std::string lifeJson(const Json& epochs) {
  return Json{{"epochs", epochs}}.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
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

  life::LedgerReader reader(file);
  std::string text;
  if (list_runs) {
    text = reader.runs();
  } else {
    const Json epochs = reportJson(reader);
    text = as_json ? lifeJson(epochs) : as_csv ? lifeCsv(epochs) : lifeText(epochs);
  }
  if (!reader.problem().empty()) return fail({reader.problem()});
  std::cout << text;
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
