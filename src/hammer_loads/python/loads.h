/// Loads of a hammer as dictionaries of NumPy arrays, named as the columns of the commands.
#pragma once

#include <optional>
#include <string>

#include "hammer_loads/python/arrays.h"
#include "hammer_loads/python/hammer.h"

namespace hammer_loads::python {

/// Weight by the hull's pitch [rad] and gravity [m/s2]; without a pitch there is none.
struct Weight {
  py::object pitch;
  std::optional<double> gravity;
};

/// Arguments that may be left out.
struct LoadOptions {
  Weight weight;
  std::optional<std::string> level;
  bool pins{};
  py::object out = py::none();  ///< arrays of an earlier result, to be written over
};

/// Of any states, as the command evaluate; the wrench columns are hull_force_x_N, hull_force_z_N, hull_torque_y_Nm.
py::dict wrenches(const Hammer& hammer, const py::object& angle, const py::object& speed,
                  const py::object& acceleration, const LoadOptions& options);

/// One turn at constant crank speed, as the command turn_table.
py::dict turn(const Hammer& hammer, double speed, double step, const LoadOptions& options);

/// The turn's pulse, as turn_table --summary.
py::dict pulse(const Hammer& hammer, double speed, const LoadOptions& options);

/// The blow of a crank that passes it at a speed [rad/s], and keeps it unless `after` is given; names as of
/// message Blow, the support impulse is that of the rocker at D.
py::dict blow(const Hammer& hammer, double before, std::optional<double> after,
              const std::optional<std::string>& level);

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
/// One call of the batch into memory that stays, for scripts/python_cost.
void bareBatch(const Hammer& hammer, const Array& angle, const Array& speed, const Array& acceleration,
               const std::string& level);

}  // namespace hammer_loads::python
