/// life: what a machine's loads took of its life so far, from its ledger.
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
  bool as_json = false, as_csv = false;
  line.option("ledger", file, "file that the node or process_bag --ledger wrote").required().type("LEDGER.sqlite");
  line.flag("--json", as_json, "as JSON");
  line.flag("--csv", as_csv, "as CSV").excludes({"--json"});
  if (const auto code = line.parse(argc, argv)) return *code;

  Checked<life::LedgerReader> reader = life::LedgerReader::open(file);
  std::vector<std::string> problems = reader.problems;
  std::vector<life::EpochReport> epochs;
  if (reader.value) {
    Checked<std::vector<life::EpochReport>> report = life::lifeReport(*reader.value);
    problems = report.problems;
    if (report.value) epochs = *std::move(report.value);
  }
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  if (!problems.empty()) return kExitFailure;
  std::cout << (as_json ? lifeJson(epochs) : as_csv ? lifeCsv(epochs) : lifeText(epochs));
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
