/// The module hammer_loads_py with the text of Python's help().
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/python/loads.h"
#include "hammer_loads/python/tables.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/util/format.h"

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
  for (const auto& [key, value] : values) numbers[key.cast<std::string>()] = numberOf(py::str(key), value);
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

constexpr char kHammerText[] = R"(A hammer whose parameters are possible. It never changes.

Hammer.from_yaml() reads one, changed() makes another one from it.)";

constexpr char kFromYaml[] = R"(Reads parameter files over the shipped ones, as --params does.

paths: a key of a later file replaces that of an earlier one. Without any hammer key the result is the MO-100.
Raises ValueError with one line for each problem.)";

constexpr char kChanged[] = R"(Returns this hammer with other values of the hammer file's keys.

values: by key, in the unit that the key ends with, for instance rod_mass_kg=4.0. The lengths must keep
crank + rod = pivot distance + rocker to 1e-3 crank lengths; the rod is corrected by the rest.)";

constexpr char kWrenches[] = R"(Returns the loads of many states of the crank, as the command evaluate does.

angle [rad]: crank angle, 0 at the blow, at most 4e8; just below 0 is just before a blow.
speed [rad/s], acceleration [rad/s2]: of the crank.
pitch [rad]: of the hull; None leaves the weight out. gravity [m/s2]: of the parameters unless given.
level: 'pulse', 'rocker' or 'linkage'; that of the parameters unless given.
Numbers, arrays of one shape, or arrays that NumPy broadcasts to one; a nan gives nan.

The result has arrays hull_force_x_N, hull_force_z_N, hull_torque_y_Nm: wrench by the links on the hull, moment
about the rocker's pivot, axes of hammer_hull. pins=True adds drive_torque_y_Nm and Rij_x_N, Rij_z_N, the force of
link i on link j (0 hull, 1 crank, 2 rod, 3 rocker).
out: an earlier result, whose arrays are overwritten and returned. This saves new memory, which costs more than the
loads of a million states.)";

constexpr char kTurn[] = R"(Returns one revolution at constant crank speed, as the command turn_table does.

speed [rad/s], step_deg [deg]: of the crank. pitch [rad], gravity [m/s2], level, pins: as in wrenches().
The result has arrays crank_angle_deg, time_s, force_x_N, force_z_N, torque_y_Nm. The first row is just after a blow,
the last one just before the next.)";

constexpr char kPulse[] = R"(Returns the force pulse of one revolution at constant crank speed, as turn_table --summary.

speed [rad/s]: of the crank. pitch [rad], gravity [m/s2], level: as in wrenches().
The result has amplitude_N, peak_angle_deg, impulse_Ns, frequency_rad_s, start_s, turn_impulse_x_Ns,
turn_impulse_z_Ns.)";

constexpr char kBlow[] = R"(Returns the blow of a crank that passes the dead centre at a speed.

crank_speed, crank_speed_after [rad/s]: before and after the blow; the crank keeps its speed unless the second is given.
level: as in wrenches().
The result has the fields of message Blow: speeds [rad/s], restitution [-], energy_J, impulses [N s]. The support
impulse is by the rocker on the hull at its pivot.)";

constexpr char kCountCycles[] = R"(Counts the load cycles of a series, as the command count_cycles does.

series: loads in their order, in any unit; nan and inf are skipped.
full_scale: (least, greatest) load of a grid of so many classes; None counts every value as it is.
The result has arrays range and mean [unit of the series] and count [-] after ASTM E1049, sorted by range, then mean.
The residue counts as half cycles.)";

constexpr char kReadDatabase[] = R"(Reads every table of a database of process_bag --db, of a ledger or of the fleet.

path: of the file. The result has a dictionary of arrays for each table, by column; names of columns end with the unit.
Whole numbers are int64, or float64 where one is missing; texts are objects. A missing value is nan or None.)";

constexpr char kSupportImpulse[] = R"(Returns the impulses of a blow of a rocker of any shape (paper P1).

mass, reduced_rod_mass [kg], inertia_about_pivot [kg m2], friction [-]: of the rocker and at the tool.
com, rod_joint, striking_point [m]: (x, z) from the pivot, axes of hammer_hull.
speed_before, speed_after [rad/s]: of the rocker; negative before the blow of a rocker that strikes at x < 0.
The result has tool_impulse_x_Ns, tool_impulse_z_Ns, support_impulse_x_Ns, support_impulse_z_Ns [N s], energy_J [J].)";

void addHammer(py::module_& module) {
  const py::arg_v speed = py::arg("speed") = 31.416;  // P0's, as of turn_table
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
      .def(
          "wrenches",
          [](const Hammer& h, const py::object& angle, const py::object& w, const py::object& e,
             const py::object& pitch, Number gravity, Text level, bool pins, const py::object& out) {
            return wrenches(h, angle, w, e, {{pitch, gravity}, std::move(level), pins, out});
          },
          kWrenches, py::arg("angle"), py::arg("speed"), py::arg("acceleration") = 0.0, py::kw_only(),
          py::arg("pitch") = py::none(), py::arg("gravity") = py::none(), py::arg("level") = py::none(),
          py::arg("pins") = false, py::arg("out") = py::none())
      .def(
          "turn",
          [](const Hammer& h, double w, double step, const py::object& pitch, Number gravity, Text level, bool pins) {
            return turn(h, w, step, {{pitch, gravity}, std::move(level), pins, py::none()});
          },
          kTurn, speed, py::kw_only(), py::arg("step_deg") = 1.0, py::arg("pitch") = py::none(),
          py::arg("gravity") = py::none(), py::arg("level") = py::none(), py::arg("pins") = false)
      .def(
          "pulse",
          [](const Hammer& h, double w, const py::object& pitch, Number gravity, Text level) {
            return pulse(h, w, {{pitch, gravity}, std::move(level), false, py::none()});
          },
          kPulse, speed, py::kw_only(), py::arg("pitch") = py::none(), py::arg("gravity") = py::none(),
          py::arg("level") = py::none())
      .def("blow", &blow, kBlow, py::arg("crank_speed"), py::arg("crank_speed_after") = py::none(), py::kw_only(),
           py::arg("level") = py::none());
}

}  // namespace

// NOLINTNEXTLINE: the macro is pybind11's
PYBIND11_MODULE(_native, module) {
  addHammer(module);
  module.def("batch", &bareBatch);
  module.def("count_cycles", &countCycles, kCountCycles, py::arg("series"), py::kw_only(),
             py::arg("full_scale") = py::none(), py::arg("classes") = 4096);
  module.def(
      "read_database",
      [](const py::object& path) {
        return readDatabase(py::module_::import("os").attr("fspath")(path).cast<std::string>());
      },
      kReadDatabase, py::arg("path"));
  module.def("support_impulse", &supportImpulse, kSupportImpulse, py::kw_only(), py::arg("mass"),
             py::arg("inertia_about_pivot"), py::arg("com"), py::arg("rod_joint") = Point{},
             py::arg("reduced_rod_mass") = 0.0, py::arg("striking_point"), py::arg("friction") = 0.0,
             py::arg("speed_before"), py::arg("speed_after"));
}

}  // namespace hammer_loads::python
