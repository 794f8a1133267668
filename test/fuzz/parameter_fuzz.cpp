// Any parameter file gives settings or one-line problems; accepted settings read back as the same settings.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads {
namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

/// A file in memory.
class File {
 public:
  File(const void* data, std::size_t size) : descriptor_(memfd_create("parameters", 0)) {
    require(descriptor_ >= 0 && write(descriptor_, data, size) == static_cast<ssize_t>(size));
  }
  ~File() { close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Returns all parameters in force, or nothing if the file is rejected.
std::string yamlOf(const void* data, std::size_t size) {
  const File file(data, size);
  std::vector<std::string> problems, notes;
  const std::optional<ParameterMap> parameters = readParameterFile(file.path(), problems);
  std::string yaml;
  if (parameters) {
    ParameterReader reader(*parameters);
    const std::optional<Mechanism> mechanism = readMechanism(reader, notes);
    readPipelineSettings(reader);
    readLogSettings(reader);
    reader.reportUnknownKeys();
    problems.insert(problems.end(), reader.problems().begin(), reader.problems().end());
    require(mechanism || !problems.empty());
    if (problems.empty()) yaml = reader.yaml();
  } else {
    require(!problems.empty());
  }
  for (const std::string& problem : problems) require(!problem.empty() && problem.find('\n') == std::string::npos);
  return yaml;
}

}  // namespace
}  // namespace hammer_loads

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string yaml = hammer_loads::yamlOf(data, size);
  if (!yaml.empty()) hammer_loads::require(hammer_loads::yamlOf(yaml.data(), yaml.size()) == yaml);
  return 0;
}
