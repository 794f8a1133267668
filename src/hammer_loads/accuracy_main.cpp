/// accuracy: what each way to the loads costs and how far it is off.
#include <fstream>
#include <iostream>

#include "hammer_loads/accuracy/session_table.h"
#include "hammer_loads/parameters/command_line.h"

namespace hammer_loads {
namespace {

int run(int argc, const char* const* argv) {
  CLI::App app("Errors of the loads over simulated working sessions of the hammer", "accuracy");
  std::vector<std::string> files;
  std::string json_file;
  addParamsOption(app, files);
  app.add_option("--json", json_file, "also write the figures to this file");
  if (const auto code = parse(app, argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;

  const std::vector<accuracy::SessionRow> sessions = accuracy::sessionTable(*settings);
  std::cout << accuracy::markdown(sessions);
  if (json_file.empty()) return 0;
  std::ofstream file(json_file);
  file << "{\"sessions\": " << accuracy::json(sessions) << "}\n";
  if (file.flush()) return 0;
  std::cerr << json_file << ": cannot be written\n";
  return kExitFailure;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
