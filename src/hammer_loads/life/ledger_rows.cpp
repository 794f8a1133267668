#include "hammer_loads/life/ledger_rows.h"

#include <utility>

namespace hammer_loads::life {
namespace {

enum Column { kId, kName, kLeast, kGreatest, kClasses, kKneeRange, kKneeCycles, kSlope, kSlopeBelow, kSensitivity };

/// Nothing when the row has no curve, or none that SnCurve takes.
std::optional<SnCurve> curveOf(const Database::Statement& row) {
  if (row.isNull(kKneeRange)) return std::nullopt;
  return SnCurve::make(row.number(kKneeRange), row.number(kKneeCycles), row.number(kSlope), row.number(kSlopeBelow))
      .value;
}

}  // namespace

std::vector<ChannelRow> channelsOf(Database& database, std::int64_t epoch) {
  Database::Statement rows(
      database,
      "SELECT channel, name, least, greatest, classes, sn_knee_range_MPa, sn_knee_cycles, sn_slope, "
      "sn_slope_below, mean_stress_sensitivity FROM channels WHERE epoch = ?1 ORDER BY channel");
  std::vector<ChannelRow> channels;
  rows.with(epoch);
  while (rows.step()) {
    const Checked<LoadGrid> grid = LoadGrid::make(rows.number(kLeast), rows.number(kGreatest), rows.integer(kClasses));
    const std::optional<SnCurve> curve = curveOf(rows);
    if (!grid.value || curve.has_value() == rows.isNull(kKneeRange)) {
      database.fail("damaged: channel " + rows.text(kName) + " has no possible grid or curve");
      break;
    }
    std::optional<FkmMeanStress> mean;
    if (!rows.isNull(kSensitivity)) mean = FkmMeanStress{rows.number(kSensitivity)};
    channels.push_back({rows.integer(kId), {rows.text(kName), *grid.value, curve, mean}});
  }
  return channels;
}

}  // namespace hammer_loads::life
