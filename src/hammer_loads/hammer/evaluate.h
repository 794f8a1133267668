/// Everything the model says of given states: what the command evaluate prints.
#pragma once

#include <array>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads {

/// Level pulse has no pins of its own: motion and pins are the rocker's.
struct Evaluation {
  double rocker_angle{};         ///< psi [rad], in [0, pi)
  double rod_angle{};            ///< beta [rad], in (-pi, pi]
  double rocker_speed{};         ///< [rad/s]
  double rocker_acceleration{};  ///< [rad/s2]
  HullWrench wrench;
  PinReactions pins;
};

/// gravity in hull axes [m/s2].
Evaluation evaluate(const HullModel& model, const CrankMotion& crank, Gravity gravity) noexcept;

/// Names of a table's pin columns: drive torque on the crank about hull +y, then Rij, force of link i on link j (0
/// hull, 1 crank, 2 rod, 3 rocker) in hull axes.
constexpr std::array<const char*, 9> kPinColumns{"drive_torque_y_Nm", "R01_x_N", "R01_z_N", "R12_x_N", "R12_z_N",
                                                 "R23_x_N",           "R23_z_N", "R03_x_N", "R03_z_N"};
/// In the order of kPinColumns.
std::array<double, kPinColumns.size()> pinValues(const PinReactions& pins) noexcept;

/// CSV of states in (columns: state_table.h), CSV of states and results out: states as given, results with 17 digits.
/// Rows in their order. With any problem nothing is written: the whole input is judged before the first line of output.
/// A state whose results are too large for a double is a problem, too.
std::vector<std::string> evaluateTable(const HullModel& model, std::istream& in, std::ostream& out);

}  // namespace hammer_loads
