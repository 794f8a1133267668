#include "hammer_loads/pipeline/hull_speed.h"

#include <algorithm>

#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {
void HullSpeed::forget() noexcept {
  count_ = 0;
  last_blow_.reset();
  at_blow_.reset();
}

HullSpeed::Point HullSpeed::after(const Point& point, StampNs stamp, double force, double by_turning,
                                  double rate) noexcept {
  const double step = seconds(stamp - point.stamp);
  Point next = point;
  next.stamp = stamp, next.force = force;
  next.integral += 0.5 * step * (point.force + force);
  next.velocity = {next.integral + by_turning, rate};
  next.way.z += 0.5 * step * (point.velocity.z + next.velocity.z);
  next.way.rate += 0.5 * step * (point.velocity.rate + next.velocity.rate);
  return next;
}

void HullSpeed::add(StampNs stamp, double force_z, double by_turning, double rate) noexcept {
  if (count_ == 0) {
    first_force_ = force_z;
    points_[0] = {stamp, 0.0, 0.0, {by_turning, rate}, {}};
  } else {
    points_[count_ % kKept] = after(back(0), stamp, force_z - first_force_, by_turning, rate);
  }
  ++count_;
}

/// Point at a stamp, extrapolated from the last point before it.
HullSpeed::Point HullSpeed::at(StampNs stamp) const noexcept {
  const std::size_t oldest = std::min<std::uint64_t>(count_, kKept) - 1;
  std::size_t k = 0;
  while (k < oldest && back(k).stamp > stamp) ++k;
  const Point& p = back(k);
  return after(p, stamp, p.force, p.velocity.z - p.integral, p.velocity.rate);
}

void HullSpeed::struck(StampNs blow) noexcept {
  at_blow_.reset();
  if (count_ == 0) return;
  if (seconds(blow - back(0).stamp) > look_back::kLine) return forget();
  const Point now = at(blow);
  const double turn = last_blow_ ? seconds(blow - last_blow_->stamp) : 0.0;
  if (turn > 0.0 && turn < kLongestTurn) {
    const auto atEnds = [&](double TipVelocity::*part) {
      return 0.5 * (last_blow_->velocity.*part + now.velocity.*part) - (now.way.*part - last_blow_->way.*part) / turn;
    };
    at_blow_ = TipVelocity{atEnds(&TipVelocity::z), atEnds(&TipVelocity::rate)};
  }
  last_blow_ = now;
}

}  // namespace hammer_loads
