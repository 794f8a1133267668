#include "hammer_loads/hammer/turn_table.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/hammer/batch.h"
#include "hammer_loads/hammer/evaluate.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Weight along the tool on a half-sine in crank angle; angles are counted back from the blow. S as in HalfSinePulse.
ConstantSpeedPulse pulseOfHalfSine(const TurnTable& table) {
  const NominalPulse& nominal = table.model.nominalPulse();
  const double w = table.speed, turn = kTwoPi;
  const double sine = nominal.amplitude * w * w;
  const double weight = table.model.mechanism().parameters().rocker_mass * table.gravity.z;
  const auto impulseFrom = [&](double left) {
    const double within = std::min(left, nominal.length);
    return (sine * (1.0 - std::cos(nominal.frequency * within)) / nominal.frequency + weight * left) / w;
  };
  ConstantSpeedPulse result;
  HalfSinePulse& pulse = result.pulse;
  pulse.period = pulse.start = turn / w;
  pulse.turn_impulse_z = weight * pulse.period;
  if (!(nominal.frequency > 0.0)) return result;
  result.peak_angle = turn - 0.5 * nominal.length;
  pulse.peak_time = result.peak_angle / w;
  pulse.amplitude = sine + weight;
  pulse.turn_impulse_z = impulseFrom(turn);
  if (!(pulse.amplitude > 0.0)) return result;
  const double rise = nominal.length - std::asin(std::max(0.0, -weight / sine)) / nominal.frequency;
  pulse.impulse = impulseFrom(weight > 0.0 ? turn : std::min(rise, turn));
  if (!(pulse.impulse > 0.0)) return result;
  pulse.frequency = 2.0 * pulse.amplitude / pulse.impulse;
  pulse.start = pulse.period - kPi / pulse.frequency;
  return result;
}

}  // namespace

std::size_t rowCount(const TurnTable& table) noexcept {
  // 360/step may round up to just above a whole number, which would repeat the last row.
  const double steps = std::ceil(360.0 / table.step * (1.0 - 1e-12));
  return static_cast<std::size_t>(steps) + 1;
}

std::vector<TurnRow> turnRows(const TurnTable& table, std::size_t first, std::size_t most) {
  const std::size_t rows = rowCount(table);
  const std::size_t count = first < rows ? std::min(most, rows - first) : 0;
  std::vector<TurnRow> result(count);
  std::vector<double> angle(count), speed(count, table.speed), acceleration(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const bool last = first + i + 1 == rows;
    const double degrees = last ? 360.0 : static_cast<double>(first + i) * table.step;
    result[i].crank_angle = degrees;
    result[i].time = degrees * kDegree / table.speed;
    angle[i] = (degrees > 180.0 ? degrees - 360.0 : degrees) * kDegree;
  }
  const CrankStates states{angle.data(), speed.data(), acceleration.data(), count};
  Eigen::Matrix<double, Eigen::Dynamic, 12> out(count, 12);
  const auto at = [&](Eigen::Index column) { return out.col(column).data(); };
  const WrenchArrays wrenches{at(0), at(1), at(2)};
  if (table.pins)
    linkLoads(table.model, states, table.gravity, wrenches,
              {at(3), at(4), at(5), at(6), at(7), at(8), at(9), at(10), at(11)});
  hullWrenches(table.model, states, table.gravity, wrenches);  // last: linkLoads has the rocker's at level pulse
  for (std::size_t i = 0; i < count; ++i) {
    const auto o = out.row(static_cast<Eigen::Index>(i));
    result[i].wrench = {o[0], o[1], o[2]};
    if (table.pins) result[i].pins = {{o[3], o[4]}, {o[5], o[6]}, {o[7], o[8]}, {o[9], o[10]}, o[11], false};
  }
  if (first + count == rows && count > 0) {  // the batch takes the blow itself as after it
    const Evaluation at_blow = evaluate(table.model, {{0.0, Side::kBeforeBlow}, table.speed, 0.0}, table.gravity);
    result.back().wrench = at_blow.wrench;
    if (table.pins) result.back().pins = at_blow.pins;
  }
  return result;
}

std::string csvHeader(const TurnTable& table) {
  std::string header = "crank_angle_deg,time_s,force_x_N,force_z_N,torque_y_Nm";
  if (!table.pins) return header;
  for (const char* column : kPinColumns) header += "," + std::string(column);
  return header;
}

std::string csvLine(const TurnTable& table, const TurnRow& row) {
  // + 0.0: no minus before a zero
  std::string line = format("%.12g,%.12g,%.12g,%.12g,%.12g", row.crank_angle, row.time, row.wrench.force_x + 0.0,
                            row.wrench.force_z + 0.0, row.wrench.torque_y + 0.0);
  if (!table.pins) return line;
  for (const double value : pinValues(row.pins)) line += format(",%.12g", value + 0.0);
  return line;
}

ConstantSpeedPulse pulseOfTurn(const TurnTable& table) {
  if (table.model.level() == Level::kPulse) return pulseOfHalfSine(table);
  return pulseAtConstantSpeed(table.model.mechanism(), table.model.level(), table.speed, table.gravity);
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
