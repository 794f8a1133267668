#include "hammer_loads/pipeline/turn_errors.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr Eigen::Index kX = 0, kZ = 1;  // rows of LoadColumns and MomentumColumns

}  // namespace

void TurnErrors::begin(StampNs blow) noexcept {
  *this = {};
  begin_ = blow;
}

void TurnErrors::sample(double force_z, const HullDeviation& deviation, const LoadColumns& columns) noexcept {
  last_force_ = force_z;
  if (force_z > std::max(0.0, kLeastLobe * peak_)) lobe_ = rise_;
  if (!(force_z > peak_)) return;
  peak_ = force_z;
  at_peak_.columns = columns.row(kZ);
  at_peak_.own = std::sqrt(std::max(0.0, square(deviation.wrench.force_z) - square(deviation.common.force_z)));
}

PulseErrors TurnErrors::end(StampNs blow, const HalfSinePulse& pulse, const HullWrench& before_blow,
                            const MomentumColumns& at_end, const MomentumColumns& weight) const noexcept {
  const Lobe turn{begin_, at_begin_};
  const auto since = [&](const Lobe& from) -> MomentumColumns {
    return from.columns - at_end + seconds(blow - from.begin) * weight;
  };
  const MomentumColumns all = since(turn);
  PulseErrors errors;
  const double scale = peak_ > 0.0 ? pulse.amplitude / peak_ : 1.0;  // the peak lies between samples
  errors.amplitude = {scale * at_peak_.columns, scale * at_peak_.own};
  errors.impulse = {since(lobe_.value_or(turn)).row(kZ), std::sqrt(2.0) * before_blow.force_z};
  errors.turn_impulse_x = {all.row(kX), std::hypot(before_blow.force_x, after_blow_.force_x)};
  errors.turn_impulse_z = {all.row(kZ), std::hypot(before_blow.force_z, after_blow_.force_z)};
  return errors;
}

}  // namespace hammer_loads
