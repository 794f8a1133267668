#include "hammer_loads/pipeline/turn_recorder.h"

#include <algorithm>

namespace hammer_loads {
namespace {

constexpr std::size_t kCapacity = 4096;  // a turn of 0.2 s at 20 kHz
// Numerical: kCapacity

}  // namespace

TurnRecorder::TurnRecorder() { points_.reserve(kCapacity + 1); }

void TurnRecorder::begin(const TurnInstant& after_blow) noexcept {
  points_.clear();
  first_ = last_ = after_blow;
  weight_impulse_x_ = weight_impulse_z_ = 0.0;
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
  last_ = instant;
  if (++skipped_ < stride_) return;
  skipped_ = 0;
  if (points_.size() == kCapacity) thin();
  points_.push_back({instant.time - first_.time, instant.wrench.force_z,
                     weight_impulse_x_ - (instant.momentum.x - first_.momentum.x),
                     weight_impulse_z_ - (instant.momentum.z - first_.momentum.z)});
}

std::optional<HalfSinePulse> TurnRecorder::end(const TurnInstant& before_blow) noexcept {
  if (!recording_) return std::nullopt;
  stride_ = 1;
  add(before_blow);
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

}  // namespace hammer_loads
