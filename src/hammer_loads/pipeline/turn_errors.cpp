#include "hammer_loads/pipeline/turn_errors.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr Eigen::Index kX = 0, kZ = 1;  // rows of LoadColumns

}  // namespace

void TurnErrors::begin(StampNs blow) noexcept {
  *this = {};
  last_ = blow;
}

void TurnErrors::addUpTo(StampNs stamp, const LoadColumns& columns) noexcept {
  const double step = seconds(stamp - last_);
  const LoadColumns mean = sampled_ ? 0.5 * (columns_ + columns) : columns;
  impulse_ += step * mean;
  if (lobe_open_) lobe_ += step * mean.row(kZ);
  columns_ = columns;
  last_ = stamp;
  sampled_ = true;
}

void TurnErrors::sample(StampNs stamp, const HullWrench& load, const HullDeviation& deviation,
                        const LoadColumns& columns) noexcept {
  if (!(stamp > last_)) return;
  addUpTo(stamp, columns);
  lobe_open_ = load.force_z > 0.0;
  if (!lobe_open_) lobe_.setZero();
  if (!(load.force_z > peak_)) return;
  peak_ = load.force_z;
  at_peak_.columns = columns.row(kZ);
  at_peak_.own = std::sqrt(std::max(0.0, square(deviation.wrench.force_z) - square(deviation.common.force_z)));
}

PulseErrors TurnErrors::end(StampNs blow, const HalfSinePulse& pulse, const HullWrench& before_blow) noexcept {
  if (blow > last_) addUpTo(blow, columns_);
  PulseErrors errors;
  const double scale = peak_ > 0.0 ? pulse.amplitude / peak_ : 1.0;  // the peak lies between samples
  errors.amplitude = {scale * at_peak_.columns, scale * at_peak_.own};
  errors.impulse = {lobe_, std::sqrt(2.0) * before_blow.force_z};
  errors.turn_impulse_x = {impulse_.row(kX), std::hypot(before_blow.force_x, after_blow_.force_x)};
  errors.turn_impulse_z = {impulse_.row(kZ), std::hypot(before_blow.force_z, after_blow_.force_z)};
  return errors;
}

}  // namespace hammer_loads
