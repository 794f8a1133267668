#include <array>

#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

constexpr std::array<Named<LoggedOutputs>, 4> kOutputs{{{"all", LoggedOutputs::kAll},
                                                        {"wrench", LoggedOutputs::kWrench},
                                                        {"per_turn", LoggedOutputs::kPerTurn},
                                                        {"none", LoggedOutputs::kNone}}};
constexpr std::array<Named<LogCompression>, 2> kCompressions{
    {{"none", LogCompression::kNone}, {"lz4", LogCompression::kLz4}}};
constexpr std::int64_t kMostMb = 1000 * 1000 * 1000;

std::uint64_t bytes(ParameterReader& reader, const char* key, std::int64_t least_mb) {
  constexpr std::uint64_t kMb = 1000 * 1000;
  return kMb * static_cast<std::uint64_t>(reader.integer(key, "MB", least_mb, kMostMb));
}

}  // namespace

LogSettings readLogSettings(ParameterReader& reader) {
  LogSettings s;
  s.enabled = reader.boolean("log_enabled");
  s.outputs = reader.choice("log_outputs", kOutputs);
  s.inputs = reader.boolean("log_inputs");
  if (s.outputs == LoggedOutputs::kNone && !s.inputs)
    reader.addProblem(
        "log_inputs: false, must be true with log_outputs: none; log_enabled: false switches the log off");
  s.compression = reader.choice("log_compression", kCompressions);
  s.directory = reader.text("log_directory");
  s.prefix = reader.text("log_prefix");
  if (s.prefix.find('/') != std::string::npos)
    reader.addProblem("log_prefix: " + quotedText(s.prefix) + ", must be a file name's beginning, without /");
  if (s.prefix == "auto") s.prefix.clear();
  s.split_size = bytes(reader, "log_split_mb", 1);
  s.total_size = bytes(reader, "log_total_mb", 0);
  s.min_free_space = bytes(reader, "log_min_free_mb", 0);
  s.queue_size = bytes(reader, "log_queue_mb", 1);
  return s;
}

}  // namespace hammer_loads
