/// accuracy: what each way to the loads costs and how far it is off.
#include <fstream>
#include <iostream>

#include "hammer_loads/bench/price_table.h"
#include "hammer_loads/bench/session_table.h"
#include "hammer_loads/commands/command_line.h"

namespace hammer_loads {
namespace {

int run(int argc, const char* const* argv) {
  CLI::App app("Price list: cost and error of every way to the loads, errors over simulated working sessions",
               "accuracy");
  std::vector<std::string> files;
  std::string json_file, only;
  addParamsOption(app, files);
  app.add_option("--json", json_file, "also write the figures to this file");
  app.add_option("--only", only, "one of the two parts")->check(CLI::IsMember({"prices", "sessions"}));
  if (const auto code = parse(app, argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;

  std::ofstream file;
  if (!json_file.empty()) file.open(json_file);  // before the computing, which takes a minute
  const auto complain = [&] {
    std::cerr << json_file << ": cannot be written\n";
    return kExitFailure;
  };
  if (!file) return complain();

  std::string json;
  if (only != "sessions") {
    const std::vector<accuracy::PriceRow> prices = accuracy::priceTable(*settings);
    std::cout << accuracy::markdown(prices) << std::flush;
    json = "\"prices\": " + accuracy::json(prices);
  }
  if (only != "prices") {
    const std::vector<accuracy::SessionRow> sessions = accuracy::sessionTable(*settings);
    std::cout << "\n### Simulated sessions\n\n" << accuracy::markdown(sessions);
    json += (json.empty() ? "" : ",\n") + ("\"sessions\": " + accuracy::json(sessions));
  }
  if (const int code = finishOutput()) return code;
  if (!json_file.empty() && !(file << '{' << json << "}\n").flush()) return complain();
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
