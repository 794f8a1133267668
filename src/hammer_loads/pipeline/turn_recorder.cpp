#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/turn_follower.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kCapacity = 4096;  // a revolution of 0.2 s at 20 kHz
// Numerical: kCapacity
constexpr Eigen::Index kX = 0, kZ = 1;  // rows of LoadColumns and MomentumColumns

}  // namespace

TurnRecorder::TurnRecorder() { points_.reserve(kCapacity + 1); }

void TurnRecorder::begin(const TurnInstant& after_blow) noexcept {
  points_.clear();
  first_ = last_ = after_blow;
  weight_impulse_x_ = weight_impulse_z_ = momentum_way_z_ = momentum_way_y_ = 0.0;
  stride_ = 1;
  skipped_ = 0;
  recording_ = true;
  points_.push_back({0.0, after_blow.wrench.force_z, 0.0, 0.0});
}

void TurnRecorder::correctBegin(const LinkMomentum& after_blow) noexcept {
  if (!recording_) return;
  for (TurnPoint& p : points_) {
    if (!(p.time > 0.0)) continue;
    p.impulse_x += after_blow.x - first_.momentum.x;
    p.impulse_z += after_blow.z - first_.momentum.z;
  }
  first_.momentum = after_blow;
}

void TurnRecorder::add(const TurnInstant& instant) noexcept {
  if (!recording_) return;
  const double step = instant.time - last_.time;
  if (!(step > 0.0)) return;
  weight_impulse_x_ += last_.weight_x * step;
  weight_impulse_z_ += last_.weight_z * step;
  momentum_way_z_ += 0.5 * step * (last_.momentum.z + instant.momentum.z);
  momentum_way_y_ += 0.5 * step * (last_.momentum.about_d + instant.momentum.about_d);
  last_ = instant;
  if (++skipped_ < stride_) return;
  skipped_ = 0;
  if (points_.size() == kCapacity) thin();
  points_.push_back({instant.time - first_.time, instant.wrench.force_z,
                     weight_impulse_x_ - (instant.momentum.x - first_.momentum.x),
                     weight_impulse_z_ - (instant.momentum.z - first_.momentum.z)});
}

std::optional<HalfSinePulse> TurnRecorder::end(const TurnInstant& before_blow) noexcept {
  const LinkMomentum& end = before_blow.momentum;
  swing_ = end;
  if (!recording_) return std::nullopt;
  stride_ = 1;
  add(before_blow);
  const double turn = before_blow.time - first_.time;
  if (turn > 0.0)
    swing_ = {0.0, momentum_way_z_ / turn - 0.5 * (first_.momentum.z + end.z),
              momentum_way_y_ / turn - 0.5 * (first_.momentum.about_d + end.about_d)};
  recording_ = false;
  const bool pushed = std::any_of(points_.begin(), points_.end(), [](const TurnPoint& p) { return p.force_z > 0.0; });
  if (points_.size() < 3 || !pushed) return std::nullopt;
  return pulseOfTurn(points_.data(), points_.size());
}

void TurnRecorder::thin() noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
  points_.resize(kept);
  stride_ *= 2;
}

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
  at_peak_.columns = columns.row(kZ).cast<double>();
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
  const double beyond = reach_ - peak_;  // an uncertain sample may have been the peak
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
