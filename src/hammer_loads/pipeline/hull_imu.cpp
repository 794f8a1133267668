#include "hammer_loads/pipeline/hull_imu.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/pipeline/reading_checks.h"

namespace hammer_loads {
namespace {

constexpr double kLargestForce = 2000.0;  // [m/s2]: 200 g, some twenty times a hull's under the MO-100's full pulse
constexpr double kLargestRate = 100.0;    // [rad/s]
// Limit: kLargestForce, kLargestRate

}  // namespace

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

/// Returns the point at a stamp, extrapolated from the last point before it.
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

std::optional<ImuRefusal> HullImu::update(StampNs stamp, const ImuReading& reading) noexcept {
  if (!reading.specific_force.allFinite() || !reading.rate.allFinite()) return ImuRefusal::kNotFinite;
  if (reading.specific_force.norm() > kLargestForce || reading.rate.norm() > kLargestRate) {
    return ImuRefusal::kImplausible;
  }
  if (readings_ > 0 && stamp <= now_.stamp) {
    const bool again = rewound_ && stamp > *rewound_;
    rewound_ = stamp;
    if (!again) return ImuRefusal::kOutOfOrder;
    readings_ = 0;
  }
  rewound_.reset();
  if (readings_ > 0 && seconds(stamp - now_.stamp) > settings_.max_age) readings_ = 0;
  const Sample next{stamp, settings_.rotation * reading.specific_force, settings_.rotation * reading.rate};
  if (readings_ > 0) {
    const bool force = force_guard_.accepts((next.force - now_.force).norm());
    const bool rate = rate_guard_.accepts((next.rate - now_.rate).norm());
    if (!force || !rate) return ImuRefusal::kJump;
  }
  const bool first = readings_ == 0;
  if (first || !cameTogether(now_.stamp, stamp)) before_ = now_, readings_ = std::min(readings_ + 1, 2);
  now_ = next;
  if (first) speed_.forget();
  speed_.add(stamp, now_.force.z(), now_.rate.y() * settings_.position.x() - now_.rate.x() * settings_.position.y(),
             now_.rate.y());
  return std::nullopt;
}

void HullImu::struck(StampNs stamp) noexcept {
  blow_ = stamp;
  speed_.struck(stamp);
}

std::optional<ImuReading> HullImu::reading(StampNs stamp) const noexcept {
  if (readings_ < 2 || std::abs(seconds(stamp - now_.stamp)) > settings_.max_age) return std::nullopt;
  const double interval = seconds(now_.stamp - before_.stamp);
  double part = std::clamp(seconds(stamp - now_.stamp) / interval, -1.0, 1.0);
  if (blowBetween(before_.stamp, now_.stamp)) {
    part = stamp < *blow_ ? -1.0 : 0.0;
  } else if (blowBetween(now_.stamp, stamp)) {
    part = 0.0;
  }
  return ImuReading{now_.force + part * (now_.force - before_.force), now_.rate + part * (now_.rate - before_.rate)};
}

std::optional<HullMotion> HullImu::at(StampNs stamp) const noexcept {
  const std::optional<ImuReading> read = reading(stamp);
  if (!read) return std::nullopt;
  const bool smooth = !blowBetween(before_.stamp, std::max(now_.stamp, stamp));
  const double interval = seconds(now_.stamp - before_.stamp);
  const Eigen::Vector3d acceleration =
      smooth ? Eigen::Vector3d((now_.rate - before_.rate) / interval) : Eigen::Vector3d::Zero();
  const Eigen::Vector3d &r = settings_.position, &rate = read->rate;
  const Eigen::Vector3d force = read->specific_force - acceleration.cross(r) - rate.cross(rate.cross(r));
  return HullMotion{{-force.x(), -force.z()}, rate.y(), acceleration.y()};
}

}  // namespace hammer_loads
