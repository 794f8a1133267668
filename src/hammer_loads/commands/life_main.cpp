/// life: damage and remaining life of a machine by its ledger.
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/life_tables.h"

namespace hammer_loads {
namespace {

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
    if (problem) std::cerr << *problem << '\n';
    return problem ? kExitFailure : 0;
  }

  Checked<life::LedgerReader> reader = life::LedgerReader::open(file);
  std::vector<std::string> problems = reader.problems;
  std::vector<life::EpochReport> epochs;
  if (reader.value && list_runs) {
    std::cout << "run,epoch,crank_messages,blows\n";
    for (const life::LedgerRunInfo& r : reader.value->runs())
      std::cout << r.name << ',' << r.epoch << ',' << r.messages << ',' << r.turns << '\n';
    if (reader.value->problem().empty()) return finishOutput();
    problems.push_back(reader.value->problem());
  } else if (reader.value) {
    Checked<std::vector<life::EpochReport>> report = life::lifeReport(*reader.value);
    problems = report.problems;
    if (report.value) epochs = *std::move(report.value);
  }
  if (!problems.empty()) return fail(problems);
  std::cout << (as_json ? lifeJson(epochs) : as_csv ? lifeCsv(epochs) : lifeText(epochs));
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
