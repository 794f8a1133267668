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

void TurnErrors::sample(double force_z, double deviation, double common, double rod,
                        const LoadColumns& columns) noexcept {
  NumberError here;
  here.own = std::sqrt(std::max(0.0, square(deviation) - square(common)));
  here.rod = rod;
  if (force_z + here.own > reach_) reach_ = force_z + here.own, highest_ = here;
  last_force_ = force_z;
  if (force_z > std::max(0.0, kLeastLobe * peak_)) lobe_ = rise_;
  if (!(force_z > peak_)) return;
  peak_ = force_z;
  at_peak_ = here;
  at_peak_.columns = columns.row(kZ);
}

PulseErrors TurnErrors::end(StampNs blow, const HalfSinePulse& pulse, const Momentum& before_blow,
                            const MomentumColumns& at_end, const MomentumColumns& weight) const noexcept {
  const Lobe turn{begin_, at_begin_};
  const auto since = [&](const Lobe& from) -> MomentumColumns {
    return from.columns - at_end + seconds(blow - from.begin) * weight;
  };
  const MomentumColumns all = since(turn);
  PulseErrors errors;
  const double scale = peak_ > 0.0 ? pulse.amplitude / peak_ : 1.0;  // the peak lies between samples
  errors.amplitude = {scale * at_peak_.columns, scale * at_peak_.own, scale * at_peak_.rod};
  const double beyond = reach_ - peak_;  // a sample that is hardly known may have been the peak
  if (beyond > errors.amplitude.own && highest_.own > 0.0)
    errors.amplitude.own = beyond, errors.amplitude.rod = beyond * highest_.rod / highest_.own;
  const auto difference = [](const NumberError::Columns& columns, double own, double by_readings) {
    NumberError error{columns, own};
    error.setRodBeyond(by_readings);
    return error;
  };
  const HullWrench &before = before_blow.all, &after = after_blow_.all;
  const HullWrench &read_before = before_blow.by_readings, &read_after = after_blow_.by_readings;
  errors.impulse = difference(since(lobe_.value_or(turn)).row(kZ), std::sqrt(2.0) * before.force_z,
                              std::sqrt(2.0) * read_before.force_z);
  errors.turn_impulse_x = difference(all.row(kX), std::hypot(before.force_x, after.force_x),
                                     std::hypot(read_before.force_x, read_after.force_x));
  errors.turn_impulse_z = difference(all.row(kZ), std::hypot(before.force_z, after.force_z),
                                     std::hypot(read_before.force_z, read_after.force_z));
  return errors;
}

}  // namespace hammer_loads
