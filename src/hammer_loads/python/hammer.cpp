#include "hammer_loads/python/hammer.h"

#include <algorithm>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/hammer_parameters.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads::python {
namespace {

/// The hammer's numbers among all parameters in force, with the rod as the mechanism corrected it.
std::map<std::string, double> hammerParameters(const std::string& yaml, const Mechanism& mechanism) {
  std::map<std::string, double> values;
  const YAML::Node all = YAML::Load(yaml);
  for (const std::string& key : hammerKeys()) {
    if (all[key]) values[key] = all[key].as<double>();
  }
  HammerParameters parameters = mechanism.parameters();
  values["rod_length_m"] = parameters.lengths.rod;
  for (const HammerConstant& constant : kHammerConstants)
    if (constant.optional) values[constant.key] = constant.field(parameters);
  return values;
}

}  // namespace

Checked<Hammer> Hammer::fromFiles(const std::vector<std::string>& files) {
  Checked<Settings> settings = loadFiles(configDirectory(), files);
  Checked<Hammer> result;
  result.problems = std::move(settings.problems);
  if (!settings.value) return result;
  Hammer hammer;
  hammer.mechanism_ = std::make_shared<const Mechanism>(settings.value->mechanism);
  hammer.parameters_ = hammerParameters(settings.value->yaml, *hammer.mechanism_);
  hammer.notes_ = std::move(settings.value->notes);
  hammer.level_ = settings.value->pipeline.level;
  hammer.gravity_ = settings.value->pipeline.gravity;
  result.value = std::move(hammer);
  return result;
}

Checked<Hammer> Hammer::changed(const std::map<std::string, double>& values) const {
  std::map<std::string, double> all = parameters_;
  for (const auto& [key, value] : values) all[key] = value;
  ParameterMap given;
  for (const auto& [key, value] : all) given[key] = {YAML::Node(numberText(value)), {}};
  ParameterReader reader(std::move(given));
  Checked<Hammer> result;
  Hammer hammer = *this;
  hammer.notes_.clear();
  const std::optional<Mechanism> mechanism = readMechanism(reader, hammer.notes_);
  reader.reportUnknownKeys();
  result.problems = reader.problems();
  if (!mechanism || !result.problems.empty()) return result;
  hammer.mechanism_ = std::make_shared<const Mechanism>(*mechanism);
  hammer.parameters_ = std::move(all);
  hammer.parameters_["rod_length_m"] = mechanism->parameters().lengths.rod;
  result.value = std::move(hammer);
  return result;
}

}  // namespace hammer_loads::python
