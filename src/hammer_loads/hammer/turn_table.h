/// Loads over one revolution at constant crank speed, row by row.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads {

/// Table of one revolution; refers to the model's mechanism, which must outlive it.
struct TurnTable {
  HullModel model;
  double speed{};   ///< crank speed [rad/s], > 0
  Gravity gravity;  ///< [m/s2], hull axes
  double step{};    ///< between rows [deg], in [1e-6, 360]
  bool pins{};      ///< pin forces and drive torque as well; level pulse: the rocker's
};

struct TurnRow {
  double crank_angle{};  ///< [deg], 0 just after a blow, 360 just before the next
  double time{};         ///< since the blow [s]
  HullWrench wrench;
  PinReactions pins;  ///< zero unless requested; near_blow is not set
};

/// Angles of the rows: 0, step, 2 step, ... below 360 deg, and 360 deg.
std::size_t rowCount(const TurnTable& table) noexcept;
/// Rows from `first` on, at most `most` of them; fewer at the end, none beyond it. They are evaluated together
/// (batch.h).
std::vector<TurnRow> turnRows(const TurnTable& table, std::size_t first, std::size_t most);

/// Names and units of the columns.
std::string csvHeader(const TurnTable& table);
/// Writes a row with 12 significant digits.
std::string csvLine(const TurnTable& table, const TurnRow& row);

/// Pulse of the revolution; at level pulse that of the half-sine with the weight on it.
ConstantSpeedPulse pulseOfTurn(const TurnTable& table);
/// Writes the pulse as `key: value` lines with 12 significant digits.
std::string summaryText(const ConstantSpeedPulse& pulse);

}  // namespace hammer_loads
