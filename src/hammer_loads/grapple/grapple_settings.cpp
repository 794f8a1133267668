#include "hammer_loads/grapple/grapple_settings.h"

#include <array>
#include <optional>
#include <utility>

#include "hammer_loads/grapple/read_grapple.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads {
namespace {

constexpr std::array<Named<SliderAcceleration>, 2> kAccelerationNames{
    {{"none", SliderAcceleration::kNone}, {"difference", SliderAcceleration::kDifference}}};

Checked<GrappleSettings> settingsFrom(ParameterMap parameters) {
  ParameterReader reader(std::move(parameters));
  const std::optional<Grapple> grapple = readGrapple(reader);
  const std::string slider_joint = reader.text("slider_joint");
  const SliderAcceleration acceleration = reader.choice("slider_acceleration", kAccelerationNames);
  const double stale_after = reader.number("stale_after_s", "s", NumberRule::positive());
  const LogSettings log = readLogSettings(reader);
  reader.reportUnknownKeys();
  Checked<GrappleSettings> result;
  result.problems = reader.problems();
  if (grapple && result.problems.empty())
    result.value = GrappleSettings{*grapple, slider_joint, acceleration, stale_after, log, reader.yaml()};
  return result;
}

}  // namespace

Checked<GrappleSettings> loadGrappleSettings(const std::string& config_directory, const ParameterMap& given) {
  Checked<GrappleSettings> result;
  ParameterMap parameters;
  std::vector<std::string> problems;
  const std::vector<std::string> shipped{config_directory + "/log.yaml", config_directory + "/grapple_node.yaml"};
  const bool all_read = addFiles(shipped, parameters, problems);
  merge(given, parameters);
  if (all_read) result = settingsFrom(std::move(parameters));
  result.problems.insert(result.problems.begin(), problems.begin(), problems.end());
  if (!result.problems.empty()) result.value.reset();
  return result;
}

Checked<GrappleSettings> loadGrappleSettings(const std::string& config_directory,
                                             const std::vector<std::string>& files) {
  Checked<GrappleSettings> result;
  ParameterMap given;
  std::vector<std::string> problems;
  // A key would seem missing that an unread file may have.
  if (addFiles(files, given, problems)) result = loadGrappleSettings(config_directory, given);
  result.problems.insert(result.problems.begin(), problems.begin(), problems.end());
  if (!result.problems.empty()) result.value.reset();
  return result;
}

}  // namespace hammer_loads
