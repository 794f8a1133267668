#include "hammer_loads/grapple/grapple_settings.h"

#include <array>
#include <utility>

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

std::optional<Grapple> readGrapple(ParameterReader& reader) {
  const std::size_t problems_before = reader.problems().size();
  GrappleParameters parameters;
  // Grapple::make judges signs and the relations between keys.
  for (const GrappleKey& key : kGrappleKeys) key.of(parameters) = reader.number(key.key, key.unit, NumberRule::any());
  parameters.drive_sign = static_cast<int>(reader.integer("drive_sign", "", -1, 1));

  Checked<Grapple> grapple = Grapple::make(parameters);
  for (const std::string& problem : grapple.problems) reader.addProblem(problem);
  if (reader.problems().size() != problems_before) return std::nullopt;
  return grapple.value;
}

Checked<Grapple> loadGrapple(const std::vector<std::string>& files) {
  return loadFrom(files, [](ParameterMap parameters) {
    ParameterReader reader(std::move(parameters));
    const std::optional<Grapple> grapple = readGrapple(reader);
    reader.reportUnknownKeys();
    return Checked<Grapple>{grapple, reader.problems(), {}};
  });
}

Checked<GrappleSettings> loadGrappleSettings(const std::string& config_directory, const ParameterMap& given) {
  return loadFrom({config_directory + "/log.yaml", config_directory + "/grapple_node.yaml"}, [&](ParameterMap all) {
    merge(given, all);
    return settingsFrom(std::move(all));
  });
}

Checked<GrappleSettings> loadGrappleSettings(const std::string& config_directory,
                                             const std::vector<std::string>& files) {
  return loadFrom(files, [&](const ParameterMap& given) { return loadGrappleSettings(config_directory, given); });
}

}  // namespace hammer_loads
