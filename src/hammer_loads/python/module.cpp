/// The compiled part of hammer_loads_py: plain arrays in and out. package/__init__.py gives them names and shapes.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/hammer/batch.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/evaluate.h"
#include "hammer_loads/hammer/turn_table.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/file_text.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::python {
namespace {

namespace py = pybind11;
using namespace py::literals;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Text = std::optional<std::string>;

/// Python's ValueError: the problems as the commands write them, a line each.
[[noreturn]] void raise(const std::vector<std::string>& problems) { throw py::value_error(joined(problems, "\n")); }

std::string pathOf(const py::handle& path) {
  return py::module_::import("os").attr("fspath")(path).cast<std::string>();
}

/// Settings from parameter files over the shipped ones, as every command takes them with --params and --urdf.
Settings settingsOf(const py::args& paths, const std::string& description = {}) {
  std::vector<std::string> files;
  for (const py::handle& path : paths) files.push_back(pathOf(path));
  Checked<Settings> settings;
  {
    const py::gil_scoped_release others_may_run;
    settings = loadFiles(configDirectory(), files, description);
  }
  if (!settings.value) raise(settings.problems);
  return *std::move(settings.value);
}

// --- Hammer --------------------------------------------------------------------------------------------------------

/// A value; copies share the mechanism.
struct Hammer {
  std::shared_ptr<const Mechanism> mechanism;
  std::map<std::string, double> parameters;  ///< in force, by the hammer file's keys, in the keys' units
  std::vector<std::string> notes;
  Level level{};     ///< level of the parameters
  double gravity{};  ///< [m/s2]
};

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

Hammer hammerFromYaml(const py::args& paths) {
  const Settings settings = settingsOf(paths);
  return {std::make_shared<const Mechanism>(settings.mechanism), hammerParameters(settings.yaml, settings.mechanism),
          settings.notes, settings.pipeline.level, settings.pipeline.gravity};
}

/// A hammer with other values of the hammer file's keys.
Hammer changed(const Hammer& hammer, const py::kwargs& values) {
  Hammer result = hammer;
  for (const auto& [key, value] : values) {
    if (!PyNumber_Check(value.ptr()))
      raise({std::string(py::str(key)) + ": " + py::repr(value).cast<std::string>() + ", must be a number"});
    result.parameters[key.cast<std::string>()] = value.cast<double>();
  }
  ParameterMap given;
  for (const auto& [key, value] : result.parameters) given[key] = {YAML::Node(numberText(value)), {}};
  ParameterReader reader(std::move(given));
  result.notes.clear();
  const std::optional<Mechanism> mechanism = readMechanism(reader, result.notes);
  reader.reportUnknownKeys();
  if (!mechanism || !reader.problems().empty()) raise(reader.problems());
  result.mechanism = std::make_shared<const Mechanism>(*mechanism);
  result.parameters["rod_length_m"] = mechanism->parameters().lengths.rod;
  return result;
}

/// The parameters by which hammers differ most, and the level.
std::string textOf(const Hammer& hammer) {
  std::string text = "<Hammer: ";
  for (const char* key : {"crank_length_m", "rod_length_m", "rocker_length_m", "pivot_distance_m", "rocker_mass_kg",
                          "rocker_inertia_about_pivot_kg_m2"})
    text += format("%s %.6g, ", key, hammer.parameters.at(key));
  return text + "level " + nameOf(hammer.level) + ">";
}

HullModel modelOf(const Hammer& hammer, const Text& word) {
  if (!word) return HullModel(*hammer.mechanism, hammer.level);
  std::vector<std::string> words;
  for (const auto& [name, level] : kRigidLevelNames) {
    if (*word == name) return HullModel(*hammer.mechanism, level);
    words.emplace_back(name);
  }
  raise({"level: " + onOneLine(*word) + " not in {" + joined(words, ",") + "}"});
}

/// A row for each column of the commands: wrench, then with pins those of kPinColumns.
Array loads(const Hammer& hammer, const Array& angle, const Array& speed, const Array& acceleration,
            const std::pair<double, double>& gravity, const Text& level, bool pins) {
  const HullModel model = modelOf(hammer, level);
  const auto count = static_cast<std::size_t>(angle.size());
  Array result({pins ? 3 + kPinColumns.size() : std::size_t{3}, count});
  const auto row = [data = result.mutable_data(), count](std::size_t index) { return data + index * count; };
  const CrankStates states{angle.data(), speed.data(), acceleration.data(), count};
  const Gravity g{gravity.first, gravity.second};
  const WrenchArrays wrench{row(0), row(1), row(2)};
  const py::gil_scoped_release others_may_run;
  if (pins) {
    const PinArrays of_pins{row(4), row(5), row(6), row(7), row(8), row(9), row(10), row(11), row(3)};
    linkLoads(model, states, g, wrench, of_pins);
  }
  // At level pulse the pins are the rocker's, the wrench its own.
  if (!pins || model.level() == Level::kPulse) hullWrenches(model, states, g, wrench);
  return result;
}

py::dict pulse(const Hammer& hammer, double speed, const std::pair<double, double>& gravity, const Text& level) {
  const ConstantSpeedPulse result =
      pulseOfTurn({modelOf(hammer, level), speed, {gravity.first, gravity.second}, 1.0, false});
  const auto& p = result.pulse;
  return py::dict("amplitude"_a = p.amplitude, "peak_angle"_a = result.peak_angle, "impulse"_a = p.impulse,
                  "angular_frequency"_a = p.frequency, "start"_a = p.start, "turn_impulse_x"_a = p.turn_impulse_x + 0.0,
                  "turn_impulse_z"_a = p.turn_impulse_z + 0.0);
}

py::dict blow(const Hammer& hammer, double before, std::optional<double> after, const Text& level) {
  const Level at = modelOf(hammer, level).level();
  const RockerBlow blow = after ? blowAtCrankSpeeds(*hammer.mechanism, at, before, *after)
                                : blowAtCrankSpeed(*hammer.mechanism, at, before);
  return py::dict("crank_speed_before"_a = before, "crank_speed_after"_a = after.value_or(before),
                  "rocker_speed_before"_a = blow.rocker_speed_before, "rocker_speed_after"_a = blow.rocker_speed_after,
                  "restitution"_a = blow.restitution, "energy"_a = blow.energy,
                  "tool_impulse_x"_a = blow.tool_impulse_x, "tool_impulse_z"_a = blow.tool_impulse_z,
                  "support_impulse_x"_a = blow.support_impulse_x, "support_impulse_z"_a = blow.support_impulse_z);
}

using Point = std::pair<double, double>;
HullPoint hullPoint(const Point& p) { return {p.first, p.second}; }

/// P1's rocker, any shape.
py::dict supportImpulse(double mass, double inertia, const Point& com, const Point& rod_joint, double rod_mass,
                        const Point& striking_point, double friction, double before, double after) {
  const StrikingRocker rocker{
      mass, inertia, hullPoint(com), hullPoint(rod_joint), rod_mass, hullPoint(striking_point), friction};
  const RockerBlow blow = blowInSupport(rocker, before, after);
  return py::dict("tool_impulse_x"_a = blow.tool_impulse_x, "tool_impulse_z"_a = blow.tool_impulse_z,
                  "support_impulse_x"_a = blow.support_impulse_x, "support_impulse_z"_a = blow.support_impulse_z,
                  "energy"_a = blow.energy);
}

// --- Boom ----------------------------------------------------------------------------------------------------------

Boom boomFromYaml(const py::object& urdf, const py::args& paths) {
  const Checked<std::string> description = fileText(pathOf(urdf));
  if (!description.value) raise(description.problems);
  Settings settings = settingsOf(paths, *description.value);
  if (!settings.boom) raise({"the robot description has no chain from base_link to hammer_hull"});
  return *std::move(settings.boom);
}

std::vector<std::string> sectionsOf(const Boom& boom) {
  std::vector<std::string> names;
  for (const SectionParameters& section : boom.parameters().sections) names.push_back(section.name);
  return names;
}

/// The boom at rest at a pose. position: of each joint [rad]; a missing joint is at 0.
Boom posed(Boom boom, const std::map<std::string, double>& position) {
  const JointVector zero = JointVector::Zero(boom.chain().joints());
  JointMotion motion{zero, zero, zero};
  for (const auto& [joint, angle] : position) {
    const std::optional<int> index = boom.chain().jointIndex(joint);
    if (!index || !std::isfinite(angle)) raise({joint + ": must be a joint of the boom with a finite position"});
    motion.position[*index] = angle;
  }
  boom.moveCompliant(motion, Eigen::Vector3d::Zero());
  return boom;
}

/// Natural frequencies [Hz], ascending.
std::vector<double> frequencies(const Boom& model, const std::map<std::string, double>& position) {
  const Boom boom = posed(model, position);
  const BoomModes& modes = boom.vibration().modes();
  std::vector<double> result;
  for (int k = 0; k < modes.count; ++k) result.push_back(modes.omega[k] / kTwoPi);
  return result;
}

/// Rows of load: time [s], never falling, force x, z [N] and moment y [N m] BY the hammer ON the hull at the origin of
/// hammer_hull, axes of that frame. Rows of the result, without weight, from rest at the first time: torque of each
/// joint [N m], then force x, z and moment y of each section. compliant: the joints vibrate on their cylinders' oil,
/// else the boom is rigid.
Array boomLoads(const Boom& model, const std::map<std::string, double>& position, const Array& load, bool compliant) {
  Boom boom = posed(model, position);
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
      raise({"force_x, force_z, torque_y: too large for a finite result"});
    for (py::ssize_t j = 0; j < joints; ++j) out(j, i) = loads.total[j];
    for (py::ssize_t k = 0; k < cuts; ++k) {
      const Eigen::Vector3d at_cut = inPlane(steel.section[static_cast<std::size_t>(k)]);
      for (py::ssize_t axis = 0; axis < 3; ++axis) out(joints + 3 * k + axis, i) = at_cut[axis];
    }
  }
  return result;
}

// --- Load cycles ---------------------------------------------------------------------------------------------------

template <typename Counter>
void countAll(Counter& counter, const Array& series) {
  for (py::ssize_t i = 0; i < series.size(); ++i) counter.add(series.data()[i]);
}

/// Rows range, mean and count.
Array countCycles(const Array& series, const std::optional<std::pair<double, double>>& full_scale,
                  std::int64_t classes) {
  std::vector<life::RangeMean> cycles;
  if (full_scale) {
    const Checked<life::LoadGrid> grid = life::LoadGrid::make(full_scale->first, full_scale->second, classes);
    if (!grid.value) raise(grid.problems);
    life::CycleCounter counter(*grid.value);
    const py::gil_scoped_release others_may_run;
    countAll(counter, series);
    cycles = life::rangesAndMeans(counter.take());
  } else {
    life::ExactCycles counter;
    const py::gil_scoped_release others_may_run;
    countAll(counter, series);
    cycles = life::rangesAndMeans(counter);
  }
  Array result({std::size_t{3}, cycles.size()});
  auto out = result.mutable_unchecked<2>();
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const auto at = static_cast<py::ssize_t>(i);
    out(0, at) = cycles[i].range, out(1, at) = cycles[i].mean, out(2, at) = cycles[i].count;
  }
  return result;
}

constexpr char kHammerText[] = R"(A hammer whose parameters are possible. It never changes.

Hammer.from_yaml() reads one, changed() makes another one from it.)";

constexpr char kFromYaml[] = R"(Reads parameter files over the shipped ones, as --params does.

paths: a key of a later file replaces that of an earlier one. Without any hammer key the result is the MO-100.
Raises ValueError with one line for each problem.)";

constexpr char kChanged[] = R"(Returns this hammer with other values of the hammer file's keys.

values: by key, in the unit that the key ends with, for instance rod_mass_kg=4.0. The lengths must keep
crank + rod = pivot distance + rocker to 1e-3 crank lengths; the rod is corrected by the rest.)";

constexpr char kBoomText[] = "A boom with the hammer on its tip. It never changes.";

constexpr char kBoomFromYaml[] = R"(Reads a robot description (URDF) and parameter files, as --urdf and --params do.

paths: a boom file, for instance config/boom_eo2621.yaml; without one the boom is rigid and has no sections.
Raises ValueError with one line for each problem.)";

constexpr char kSupportImpulse[] = R"(Returns the impulses of a blow of a rocker of any shape (paper P1).

mass, reduced_rod_mass [kg], inertia_about_pivot [kg m2], friction [-]: of the rocker and at the tool.
com, rod_joint, striking_point [m]: (x, z) from the pivot, axes of hammer_hull.
speed_before, speed_after [rad/s]: of the rocker; negative before the blow of a rocker that strikes at x < 0.
The result has tool_impulse_x, tool_impulse_z, support_impulse_x, support_impulse_z [N s], energy [J].)";

}  // namespace

// NOLINTNEXTLINE: the macro is pybind11's
PYBIND11_MODULE(_native, module) {
  py::class_<Hammer>(module, "Hammer", kHammerText)
      .def_static("from_yaml", &hammerFromYaml, kFromYaml)
      .def("changed", &changed, kChanged)
      .def("__repr__", &textOf)
      .def_readonly("parameters", &Hammer::parameters,
                    "Values in force by the hammer file's keys, which end with the unit; the rod is corrected.")
      .def_readonly("notes", &Hammer::notes, "Lines that the commands would print as notes.")
      .def_property_readonly(
          "level", [](const Hammer& h) { return std::string(nameOf(h.level)); },
          "Level of the model in the parameters; each call may name another.")
      .def_readonly("gravity", &Hammer::gravity, "Gravity in the parameters [m/s2].")
      .def("_loads", &loads)
      .def("_pulse", &pulse)
      .def("_blow", &blow);
  py::class_<Boom>(module, "Boom", kBoomText)
      .def_static("from_yaml", &boomFromYaml, kBoomFromYaml, py::arg("urdf"))
      .def_property_readonly(
          "joints", [](const Boom& boom) { return boom.chain().jointNames(); },
          "Names of the joints, from the machine to the hammer.")
      .def_property_readonly("sections", &sectionsOf, "Names of the sections in the boom file.")
      .def("frequencies", &frequencies, "Returns the natural frequencies [Hz] at a position by joint name.",
           py::arg("joints"))
      .def("_loads", &boomLoads);
  module.def("count_cycles", &countCycles);
  module.def("support_impulse", &supportImpulse, kSupportImpulse, py::kw_only(), py::arg("mass"),
             py::arg("inertia_about_pivot"), py::arg("com"), py::arg("rod_joint") = Point{},
             py::arg("reduced_rod_mass") = 0.0, py::arg("striking_point"), py::arg("friction") = 0.0,
             py::arg("speed_before"), py::arg("speed_after"));
}

}  // namespace hammer_loads::python
