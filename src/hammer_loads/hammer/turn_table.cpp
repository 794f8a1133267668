#include "hammer_loads/hammer/turn_table.h"

#include <cmath>

#include "hammer_loads/linkage/format.h"

namespace hammer_loads {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;  // [rad]

}  // namespace

std::size_t rowCount(const TurnTable& table) noexcept {
  // 360/step may round up to just above a whole number, which would repeat the last row.
  const double steps = std::ceil(360.0 / table.step * (1.0 - 1e-12));
  return static_cast<std::size_t>(steps) + 1;
}

TurnRow turnRow(const TurnTable& table, std::size_t index) noexcept {
  TurnRow row;
  const bool last = index + 1 == rowCount(table);
  row.crank_angle = last ? 360.0 : static_cast<double>(index) * table.step;
  row.time = row.crank_angle * kDegree / table.speed;
  const bool before_blow = row.crank_angle > 180.0;
  const CrankAngle angle = before_blow ? CrankAngle{(row.crank_angle - 360.0) * kDegree, Side::kBeforeBlow}
                                       : CrankAngle{row.crank_angle * kDegree, Side::kAfterBlow};
  row.wrench = hullWrench(table.mechanism, table.level, {angle, table.speed, 0.0}, table.gravity);
  return row;
}

std::string csvHeader() { return "crank_angle_deg,time_s,force_x_N,force_z_N,torque_y_Nm"; }

std::string csvLine(const TurnRow& row) {
  // + 0.0: no minus before a zero
  return format("%.12g,%.12g,%.12g,%.12g,%.12g", row.crank_angle, row.time, row.wrench.force_x + 0.0,
                row.wrench.force_z + 0.0, row.wrench.torque_y + 0.0);
}

std::string summaryText(const ConstantSpeedPulse& result) {
  const HalfSinePulse& pulse = result.pulse;
  return format(
      "amplitude_N: %.12g\npeak_angle_deg: %.12g\nimpulse_Ns: %.12g\nfrequency_rad_s: %.12g\nstart_s: %.12g\n"
      "turn_impulse_x_Ns: %.12g\nturn_impulse_z_Ns: %.12g\n",
      pulse.amplitude, result.peak_angle / kDegree, pulse.impulse, pulse.frequency, pulse.start,
      pulse.turn_impulse_x + 0.0, pulse.turn_impulse_z + 0.0);
}

}  // namespace hammer_loads
