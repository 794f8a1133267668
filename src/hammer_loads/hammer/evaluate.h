/// All results of the model for given states, as printed by the command evaluate.
#pragma once

#include <array>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads {

/// Results of one state. At level pulse, motion and pin forces are those of level rocker.
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
/// Pin forces in the order of kPinColumns.
std::array<double, kPinColumns.size()> pinValues(const PinReactions& pins) noexcept;

/// Columns that a table of states must have, in any order; others are ignored, so that a table of results can be read
/// again.
constexpr std::array<const char*, 5> kStateColumns{"crank_angle_rad", "crank_speed_rad_s", "crank_accel_rad_s2",
                                                   "hull_pitch_rad", "gravity_m_s2"};

/// Crank angle from its decimal text, at most 1e15 rad in size; digits beyond a double's count.
///
/// Offset = text - 2 pi n, rounded to a double once. From a text with more digits than a double's 17, 2 pi n rounded to
/// the text's last digit is subtracted: 2 pi n + offset written to this many digits gives the offset back, as when 1e-9
/// rad before the blow is written 6.2831853061795864769. Either way the offset is right to one unit of that digit.
std::optional<CrankAngle> crankAngleFromText(const std::string& text);

/// Reads a CSV table of states; writes the states as given with their results to 17 digits, in the order of the rows.
/// Blank lines are skipped, but counted. Returns one line for each bad cell, at most 20; then nothing is written. A
/// state whose results overflow a double is an error, too.
std::vector<std::string> evaluateTable(const HullModel& model, std::istream& in, std::ostream& out);

}  // namespace hammer_loads
