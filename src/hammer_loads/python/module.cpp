/// The compiled part of hammer_loads_py: plain arrays in and out. package/__init__.py gives them names and shapes.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <fstream>
#include <iterator>

#include "hammer_loads/hammer/batch.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/evaluate.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/python/models.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::python {
namespace {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Text = std::optional<std::string>;

/// Python's ValueError: the problems as the commands write them, a line each.
[[noreturn]] void raise(const std::vector<std::string>& problems) { throw py::value_error(joined(problems, "\n")); }

/// A hammer or boom, or its problems as an exception.
template <typename Model>
Model valueOf(Checked<Model> made) {
  if (!made.value) raise(made.problems);
  return *std::move(made.value);
}

std::string pathOf(const py::handle& path) {
  return py::module_::import("os").attr("fspath")(path).cast<std::string>();
}

std::vector<std::string> pathsOf(const py::args& paths) {
  std::vector<std::string> files;
  for (const py::handle& path : paths) files.push_back(pathOf(path));
  return files;
}

BoomModel boomFromYaml(const py::object& urdf, const py::args& paths) {
  const std::string path = pathOf(urdf);
  std::ifstream file(path);
  if (!file) raise({path + ": cannot be read"});
  const std::string description{std::istreambuf_iterator<char>(file), {}};
  return valueOf(BoomModel::fromFiles(description, pathsOf(paths)));
}

Hammer fromYaml(const py::args& paths) {
  const std::vector<std::string> files = pathsOf(paths);
  const py::gil_scoped_release others_may_run;
  Checked<Hammer> made = Hammer::fromFiles(files);
  const py::gil_scoped_acquire again;
  return valueOf(std::move(made));
}

Hammer changed(const Hammer& hammer, const py::kwargs& values) {
  std::map<std::string, double> numbers;
  for (const auto& [key, value] : values) {
    if (!PyNumber_Check(value.ptr()))
      raise({std::string(py::str(key)) + ": " + py::repr(value).cast<std::string>() + ", must be a number"});
    numbers[key.cast<std::string>()] = value.cast<double>();
  }
  return valueOf(hammer.changed(numbers));
}

/// The parameters by which hammers differ most, and the level.
std::string textOf(const Hammer& hammer) {
  std::string text = "<Hammer: ";
  for (const char* key : {"crank_length_m", "rod_length_m", "rocker_length_m", "pivot_distance_m", "rocker_mass_kg",
                          "rocker_inertia_about_pivot_kg_m2"})
    text += format("%s %.6g, ", key, hammer.parameters().at(key));
  return text + "level " + nameOf(hammer.level()) + ">";
}

HullModel modelOf(const Hammer& hammer, const Text& word) {
  if (!word) return HullModel(hammer.mechanism(), hammer.level());
  std::vector<std::string> words;
  for (const auto& [name, level] : kRigidLevelNames) {
    if (*word == name) return HullModel(hammer.mechanism(), level);
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
  py::dict values;
  values["amplitude"] = result.pulse.amplitude;
  values["peak_angle"] = result.peak_angle;
  values["impulse"] = result.pulse.impulse;
  values["angular_frequency"] = result.pulse.frequency;
  values["start"] = result.pulse.start;
  values["turn_impulse_x"] = result.pulse.turn_impulse_x + 0.0;
  values["turn_impulse_z"] = result.pulse.turn_impulse_z + 0.0;
  return values;
}

py::dict blow(const Hammer& hammer, double before, std::optional<double> after, const Text& level) {
  const Level at = modelOf(hammer, level).level();
  const RockerBlow result = after ? blowAtCrankSpeeds(hammer.mechanism(), at, before, *after)
                                  : blowAtCrankSpeed(hammer.mechanism(), at, before);
  py::dict values;
  values["crank_speed_before"] = before;
  values["crank_speed_after"] = after.value_or(before);
  values["rocker_speed_before"] = result.rocker_speed_before;
  values["rocker_speed_after"] = result.rocker_speed_after;
  values["restitution"] = result.restitution;
  values["energy"] = result.energy;
  values["tool_impulse_x"] = result.tool_impulse_x;
  values["tool_impulse_z"] = result.tool_impulse_z;
  values["support_impulse_x"] = result.support_impulse_x;
  values["support_impulse_z"] = result.support_impulse_z;
  return values;
}

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

using Point = std::pair<double, double>;
HullPoint hullPoint(const Point& p) { return {p.first, p.second}; }

/// P1's rocker, any shape.
py::dict supportImpulse(double mass, double inertia, const Point& com, const Point& rod_joint, double rod_mass,
                        const Point& striking_point, double friction, double before, double after) {
  const StrikingRocker rocker{
      mass, inertia, hullPoint(com), hullPoint(rod_joint), rod_mass, hullPoint(striking_point), friction};
  const RockerBlow blow = blowInSupport(rocker, before, after);
  py::dict values;
  values["tool_impulse_x"] = blow.tool_impulse_x;
  values["tool_impulse_z"] = blow.tool_impulse_z;
  values["support_impulse_x"] = blow.support_impulse_x;
  values["support_impulse_z"] = blow.support_impulse_z;
  values["energy"] = blow.energy;
  return values;
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
      .def_static("from_yaml", &fromYaml, kFromYaml)
      .def("changed", &changed, kChanged)
      .def("__repr__", &textOf)
      .def_property_readonly(
          "parameters", &Hammer::parameters,
          "Values in force by the hammer file's keys, which end with the unit; the rod is corrected.")
      .def_property_readonly("notes", &Hammer::notes, "Lines that the commands would print as notes.")
      .def_property_readonly(
          "level", [](const Hammer& h) { return std::string(nameOf(h.level())); },
          "Level of the model in the parameters; each call may name another.")
      .def_property_readonly("gravity", &Hammer::gravity, "Gravity in the parameters [m/s2].")
      .def("_loads", &loads)
      .def("_pulse", &pulse)
      .def("_blow", &blow);
  py::class_<BoomModel>(module, "Boom", kBoomText)
      .def_static("from_yaml", &boomFromYaml, kBoomFromYaml, py::arg("urdf"))
      .def_property_readonly("joints", &BoomModel::joints, "Names of the joints, from the machine to the hammer.")
      .def_property_readonly("sections", &BoomModel::sections, "Names of the sections in the boom file.")
      .def("frequencies", &BoomModel::frequencies, "Returns the natural frequencies [Hz] at a position by joint name.",
           py::arg("joints"))
      .def("_loads", &BoomModel::loads);
  module.def("count_cycles", &countCycles);
  module.def("support_impulse", &supportImpulse, kSupportImpulse, py::kw_only(), py::arg("mass"),
             py::arg("inertia_about_pivot"), py::arg("com"), py::arg("rod_joint") = Point{},
             py::arg("reduced_rod_mass") = 0.0, py::arg("striking_point"), py::arg("friction") = 0.0,
             py::arg("speed_before"), py::arg("speed_after"));
}

}  // namespace hammer_loads::python
