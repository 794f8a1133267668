#include "hammer_loads/python/models.h"

#include <cmath>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"

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

namespace py = pybind11;

Checked<BoomModel> BoomModel::fromFiles(const std::string& description, const std::vector<std::string>& files) {
  Checked<Settings> settings = loadFiles(configDirectory(), files, description);
  Checked<BoomModel> result;
  result.problems = std::move(settings.problems);
  if (!settings.value) return result;
  if (!settings.value->boom) {
    result.problems.emplace_back("the robot description has no chain from base_link to hammer_hull");
    return result;
  }
  BoomModel model;
  model.boom_ = std::make_shared<const Boom>(*settings.value->boom);
  result.value = std::move(model);
  return result;
}

std::vector<std::string> BoomModel::sections() const {
  std::vector<std::string> names;
  for (const SectionParameters& section : boom_->parameters().sections) names.push_back(section.name);
  return names;
}

Boom BoomModel::posed(const std::map<std::string, double>& position) const {
  Boom boom = *boom_;
  const JointVector zero = JointVector::Zero(boom.chain().joints());
  JointMotion motion{zero, zero, zero};
  for (const auto& [joint, angle] : position) {
    const std::optional<int> index = boom.chain().jointIndex(joint);
    if (!index || !std::isfinite(angle))
      throw py::value_error(joint + ": must be a joint of the boom with a finite position");
    motion.position[*index] = angle;
  }
  boom.moveCompliant(motion, Eigen::Vector3d::Zero());
  return boom;
}

std::vector<double> BoomModel::frequencies(const std::map<std::string, double>& position) const {
  const Boom boom = posed(position);
  const BoomModes& modes = boom.vibration().modes();
  std::vector<double> result;
  for (int k = 0; k < modes.count; ++k) result.push_back(modes.omega[k] / kTwoPi);
  return result;
}

BoomModel::Array BoomModel::loads(const std::map<std::string, double>& position, const Array& load,
                                  bool compliant) const {
  Boom boom = posed(position);
  const auto in = load.unchecked<2>();
  const py::ssize_t joints = boom.chain().joints(), cuts = static_cast<py::ssize_t>(boom.sections().size());
  Array result({joints + 3 * cuts, in.shape(1)});
  auto out = result.mutable_unchecked<2>();
  BoomLoads loads;
  SteelLoads steel;
  TorqueStep step;
  for (py::ssize_t i = 0; i < in.shape(1); ++i) {
    const Wrench w_tip{{in(1, i), 0.0, in(2, i)}, {0.0, in(3, i), 0.0}};
    step.to = boom.hammerTorque(w_tip);
    if (compliant && i > 0) {
      step.mean = 0.5 * (step.from + step.to);
      boom.vibration().advance(in(0, i) - in(0, i - 1), step);
    }
    step.from = step.to;
    const ChainLoads links = boom.chainLoads(!compliant);
    if (!boom.loads(w_tip, !compliant, links, loads) || !boom.steelLoads(w_tip, links, steel))
      throw py::value_error("force_x, force_z, torque_y: too large for a finite result");
    for (py::ssize_t j = 0; j < joints; ++j) out(j, i) = loads.total[j];
    for (py::ssize_t k = 0; k < cuts; ++k) {
      const Eigen::Vector3d at_cut = inPlane(steel.section[static_cast<std::size_t>(k)]);
      for (py::ssize_t axis = 0; axis < 3; ++axis) out(joints + 3 * k + axis, i) = at_cut[axis];
    }
  }
  return result;
}

}  // namespace hammer_loads::python
