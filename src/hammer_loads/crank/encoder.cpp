#include "hammer_loads/crank/encoder.h"

#include <cmath>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {

Checked<CrankSensor> CrankSensor::make(const CrankSensorPlace& place) {
  Checked<CrankSensor> result;
  const double steepest = place.eccentricity[0] + 2.0 * place.eccentricity[1];
  if (place.direction != 1 && place.direction != -1)
    result.problems.push_back(format("crank_direction: %d, must be 1 or -1", place.direction));
  if (!(place.ratio > 0.0) || !std::isfinite(place.ratio))
    result.problems.push_back(format("crank_ratio: %.9g, must be > 0", place.ratio));
  if (place.ratio != 1.0 && steepest != 0.0) {
    result.problems.push_back(
        format("crank_ratio: %.9g, must be 1 with crank_eccentricity_1_rad or crank_eccentricity_2_rad", place.ratio));
  }
  if (!(place.eccentricity[0] >= 0.0 && place.eccentricity[1] >= 0.0 && steepest < 1.0)) {
    result.problems.push_back(
        format("crank_eccentricity_1_rad: %.9g rad, must be >= 0 and with twice crank_eccentricity_2_rad = %.9g rad "
               "below 1, else the reading turns back",
               place.eccentricity[0], place.eccentricity[1]));
  }
  if (!result.problems.empty()) return result;
  CrankSensor sensor;
  sensor.place_ = place;
  for (int i = 0; i < 2; ++i) sensor.offset_[i] = place.eccentricity[i] * std::sin(place.eccentricity_phase[i]);
  sensor.gain_ = place.direction / place.ratio;
  sensor.centred_ = steepest == 0.0;
  sensor.identity_ = sensor.centred_ && place.zero == 0.0 && sensor.gain_ == 1.0;
  result.value = sensor;
  return result;
}

/// Excess of the eccentric reading over the angle [rad].
double CrankSensor::excess(double angle) const noexcept {
  const auto& a = place_.eccentricity;
  const auto& phase = place_.eccentricity_phase;
  return (a[0] * std::sin(angle + phase[0]) - offset_[0]) + (a[1] * std::sin(2.0 * angle + phase[1]) - offset_[1]);
}

double CrankSensor::slope(double angle) const noexcept {
  const auto& a = place_.eccentricity;
  const auto& phase = place_.eccentricity_phase;
  return 1.0 + a[0] * std::cos(angle + phase[0]) + 2.0 * a[1] * std::cos(2.0 * angle + phase[1]);
}

double CrankSensor::reading(double angle) const noexcept {
  if (identity_) return angle;
  const double seen = centred_ ? angle : angle + excess(angle);
  return place_.zero + seen / gain_;
}

/// Newton's method within the revolution, kept in a bracket, since the reading grows with the angle everywhere.
double CrankSensor::angle(double reading) const noexcept {
  if (identity_) return reading;
  const double seen = (reading - place_.zero) * gain_;
  if (centred_) return seen;
  const double start = CrankAngle::wrapToPi(seen);
  const double most = 2.0 * (place_.eccentricity[0] + place_.eccentricity[1]);
  double low = -most, high = most, change = -excess(start);
  for (int i = 0; i < 60; ++i) {
    const double error = change + excess(start + change);
    (error > 0.0 ? high : low) = change;
    const double step = error / slope(start + change);
    if (std::abs(step) < 1e-15) break;
    const double next = change - step;
    change = next > low && next < high ? next : 0.5 * (low + high);
  }
  return seen + change;
}

double CrankSensor::speed(double angle, double measured) const noexcept {
  if (identity_) return measured;
  const double seen = measured * gain_;
  return centred_ ? seen : seen / slope(angle);
}

}  // namespace hammer_loads
