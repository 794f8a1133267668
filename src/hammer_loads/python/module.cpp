/// The module hammer_loads_py; what each call does, and in which unit, is said in package/__init__.pyi.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/python/loads.h"
#include "hammer_loads/python/tables.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads::python {
namespace {

/// A hammer, or its problems as an exception.
Hammer valueOf(Checked<Hammer> made) {
  if (!made.value) raise(made.problems);
  return *std::move(made.value);
}

Hammer fromYaml(const py::args& paths) {
  std::vector<std::string> files;
  const py::object text_of = py::module_::import("os").attr("fspath");
  for (const py::handle& path : paths) files.push_back(text_of(path).cast<std::string>());
  const py::gil_scoped_release others_may_run;
  Checked<Hammer> made = Hammer::fromFiles(files);
  const py::gil_scoped_acquire again;
  return valueOf(std::move(made));
}

Hammer changed(const Hammer& hammer, const py::kwargs& values) {
  std::map<std::string, double> numbers;
  for (const auto& [key, value] : values) numbers[key.cast<std::string>()] = value.cast<double>();
  return valueOf(hammer.changed(numbers));
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
  values["tool_impulse_x_Ns"] = blow.tool_impulse_x;
  values["tool_impulse_z_Ns"] = blow.tool_impulse_z;
  values["support_impulse_x_Ns"] = blow.support_impulse_x;
  values["support_impulse_z_Ns"] = blow.support_impulse_z;
  values["energy_J"] = blow.energy;
  return values;
}

using Text = std::optional<std::string>;
using Number = std::optional<double>;

void addHammer(py::module_& module) {
  const py::arg_v speed = py::arg("speed") = 31.416;  // P0's, as of turn_table
  py::class_<Hammer>(module, "Hammer")
      .def_static("from_yaml", &fromYaml)
      .def("changed", &changed)
      .def_property_readonly("parameters", &Hammer::parameters)
      .def_property_readonly("notes", &Hammer::notes)
      .def_property_readonly("level", [](const Hammer& h) { return std::string(nameOf(h.level())); })
      .def_property_readonly("gravity", &Hammer::gravity)
      .def(
          "wrenches",
          [](const Hammer& h, const py::object& angle, const py::object& w, const py::object& e,
             const py::object& pitch, Number gravity, Text level, bool pins, const py::object& out) {
            return wrenches(h, angle, w, e, {{pitch, gravity}, std::move(level), pins, out});
          },
          py::arg("angle"), py::arg("speed"), py::arg("acceleration") = 0.0, py::kw_only(),
          py::arg("pitch") = py::none(), py::arg("gravity") = py::none(), py::arg("level") = py::none(),
          py::arg("pins") = false, py::arg("out") = py::none())
      .def(
          "turn",
          [](const Hammer& h, double w, double step, const py::object& pitch, Number gravity, Text level, bool pins) {
            return turn(h, w, step, {{pitch, gravity}, std::move(level), pins, py::none()});
          },
          speed, py::kw_only(), py::arg("step_deg") = 1.0, py::arg("pitch") = py::none(),
          py::arg("gravity") = py::none(), py::arg("level") = py::none(), py::arg("pins") = false)
      .def(
          "pulse",
          [](const Hammer& h, double w, const py::object& pitch, Number gravity, Text level) {
            return pulse(h, w, {{pitch, gravity}, std::move(level), false, py::none()});
          },
          speed, py::kw_only(), py::arg("pitch") = py::none(), py::arg("gravity") = py::none(),
          py::arg("level") = py::none())
      .def("blow", &blow, py::arg("crank_speed"), py::arg("crank_speed_after") = py::none(), py::kw_only(),
           py::arg("level") = py::none());
}

}  // namespace

// NOLINTNEXTLINE: the macro is pybind11's
PYBIND11_MODULE(_native, module) {
  addHammer(module);
  module.def("batch", &bareBatch);
  module.def("count_cycles", &countCycles, py::arg("series"), py::kw_only(), py::arg("full_scale") = py::none(),
             py::arg("classes") = 4096);
  module.def(
      "read_database",
      [](const py::object& path) {
        return readDatabase(py::module_::import("os").attr("fspath")(path).cast<std::string>());
      },
      py::arg("path"));
  module.def("support_impulse", &supportImpulse, py::kw_only(), py::arg("mass"), py::arg("inertia_about_pivot"),
             py::arg("com"), py::arg("rod_joint") = Point{}, py::arg("reduced_rod_mass") = 0.0,
             py::arg("striking_point"), py::arg("friction") = 0.0, py::arg("speed_before"), py::arg("speed_after"));
}

}  // namespace hammer_loads::python
