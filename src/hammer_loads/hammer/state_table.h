/// States of crank and hull as a CSV table gives them.
#pragma once

#include <array>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/hull_motion.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Columns that a table must have, in any order; others are ignored, so that a table of results can be read again.
constexpr std::array<const char*, 5> kStateColumns{"crank_angle_rad", "crank_speed_rad_s", "crank_accel_rad_s2",
                                                   "hull_pitch_rad", "gravity_m_s2"};

struct TableState {
  CrankMotion crank;
  Gravity gravity;   ///< hull axes [m/s2], from the row's pitch and gravity
  std::string text;  ///< the cells of kStateColumns as given, joined by commas
  std::size_t row;   ///< lines below the header line, 1 for the first
};

/// Crank angle from its decimal text, sized at most 1e15 rad. Digits beyond a double's count.
///
/// Offset = text - 2 pi n, rounded to a double once. Of a text with more digits than a double's 17, 2 pi n rounded to
/// the text's last digit is subtracted: 2 pi n + offset written to this many digits gives the offset back, as when 1e-9
/// rad before the blow is written 6.2831853061795864769. Either way the offset is right to one unit of that digit.
std::optional<CrankAngle> crankAngleFromText(const std::string& text);

/// Reads a table to its end. Every bad cell is a problem `row N: COLUMN: VALUE UNIT, must be RULE`, the first 20 of
/// them one line each. Blank lines are skipped, but counted.
Checked<std::vector<TableState>> readStates(std::istream& in);

/// At most `most` lines, the last one with how many were left out.
std::vector<std::string> shortened(std::vector<std::string> lines, std::size_t most);

}  // namespace hammer_loads
