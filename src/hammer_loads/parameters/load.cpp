#include "hammer_loads/parameters/load.h"

#include <dlfcn.h>

#include <filesystem>
#include <utility>

#include "hammer_loads/hammer/choose_level.h"
#include "hammer_loads/parameters/hammer_parameters.h"
#include "hammer_loads/parameters/parameter_reader.h"

#ifndef HAMMER_LOADS_CONFIG_DIR
#error "HAMMER_LOADS_CONFIG_DIR must name the source tree's config directory"
#endif

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

Checked<Settings> settingsFrom(ParameterMap parameters) {
  Checked<Settings> result;
  ParameterReader reader(std::move(parameters));
  const std::optional<Mechanism> mechanism = readMechanism(reader, result.notes);
  PipelineSettings pipeline = readPipelineSettings(reader);
  const LogSettings log = readLogSettings(reader);
  reader.reportUnknownKeys();
  result.problems = reader.problems();
  if (!mechanism || !result.problems.empty()) return result;
  if (pipeline.choose_level) {
    const LevelChoice choice = chooseLevel(*mechanism, pipeline.tolerance, pipeline.turn_rate, pipeline.gravity);
    pipeline.level = choice.level;
    result.notes.push_back(describe(choice));
  }
  result.value = Settings{*mechanism, pipeline, log, reader.yaml(), {}};
  return result;
}

}  // namespace

Checked<Settings> load(const std::string& config_directory, const ParameterMap& given) {
  std::vector<std::string> shipped{config_directory + "/pipeline.yaml", config_directory + "/log.yaml"};
  if (!hasHammerKey(given)) shipped.push_back(config_directory + "/hammer_mo100.yaml");

  std::vector<std::string> problems;
  ParameterMap parameters;
  const bool all_read = addFiles(shipped, parameters, problems);
  merge(given, parameters);
  Checked<Settings> result;
  if (all_read) result = settingsFrom(std::move(parameters));
  result.problems.insert(result.problems.begin(), problems.begin(), problems.end());
  if (!result.problems.empty()) result.value.reset();
  if (result.value) result.value->notes = result.notes;
  return result;
}

Checked<Settings> loadFiles(const std::string& config_directory, const std::vector<std::string>& files) {
  std::vector<std::string> problems;
  ParameterMap given;
  const bool all_read = addFiles(files, given, problems);
  Checked<Settings> result;
  if (all_read) result = load(config_directory, given);  // else keys would seem missing that the unread file may have
  result.problems.insert(result.problems.begin(), problems.begin(), problems.end());
  if (!result.problems.empty()) result.value.reset();
  return result;
}

std::string configDirectory() {
  std::error_code error;
  std::vector<fs::path> candidates;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);  // PREFIX/lib/hammer_loads/PROGRAM
  if (!error) candidates.push_back(program.parent_path() / "../../share/hammer_loads/config");
  Dl_info library{};  // PREFIX/lib/LIBRARY, for a nodelet in another package's program
  if (dladdr(reinterpret_cast<void*>(&configDirectory), &library) != 0 && library.dli_fname != nullptr)
    candidates.push_back(fs::path(library.dli_fname).parent_path() / "../share/hammer_loads/config");
  for (const fs::path& candidate : candidates) {
    if (fs::exists(candidate / "pipeline.yaml", error)) return candidate.lexically_normal().string();
  }
  return HAMMER_LOADS_CONFIG_DIR;
}

}  // namespace hammer_loads
