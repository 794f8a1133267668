/// One turn at constant crank speed, row by row.
#pragma once

#include <cstddef>
#include <string>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/hammer/pulse.h"

namespace hammer_loads {

/// Refers to the mechanism, which must outlive it.
struct TurnTable {
  const Mechanism& mechanism;
  Level level{};
  double speed{};   ///< of the crank [rad/s], > 0
  Gravity gravity;  ///< [m/s2], hull axes
  double step{};    ///< between rows [deg], in [1e-6, 360]
};

struct TurnRow {
  double crank_angle{};  ///< [deg], 0 just after a blow, 360 just before the next
  double time{};         ///< since the blow [s]
  HullWrench wrench;
};

/// 0, step, 2 step, ... below 360 deg, and 360 deg.
std::size_t rowCount(const TurnTable& table) noexcept;
/// index < rowCount(table).
TurnRow turnRow(const TurnTable& table, std::size_t index) noexcept;

/// Names and units of the columns.
std::string csvHeader();
/// 12 significant digits.
std::string csvLine(const TurnRow& row);
/// `key: value` lines, 12 significant digits.
std::string summaryText(const ConstantSpeedPulse& pulse);

}  // namespace hammer_loads
