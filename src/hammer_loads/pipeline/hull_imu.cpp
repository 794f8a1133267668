#include "hammer_loads/pipeline/hull_imu.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kLargestForce = 2000.0;  // [m/s2]: 200 g, some twenty times a hull's under the MO-100's full pulse
constexpr double kLargestRate = 100.0;    // [rad/s]

}  // namespace

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
  before_ = now_;
  now_ = {stamp, settings_.rotation * reading.specific_force, settings_.rotation * reading.rate};
  readings_ = std::min(readings_ + 1, 2);
  return std::nullopt;
}

std::optional<HullMotion> HullImu::at(StampNs stamp) const noexcept {
  if (readings_ < 2 || std::abs(seconds(stamp - now_.stamp)) > settings_.max_age) return std::nullopt;
  const double interval = seconds(now_.stamp - before_.stamp);
  const double part = std::clamp(seconds(stamp - now_.stamp) / interval, -1.0, 1.0);
  const Eigen::Vector3d rate = now_.rate + part * (now_.rate - before_.rate);
  const Eigen::Vector3d acceleration = (now_.rate - before_.rate) / interval;
  const Eigen::Vector3d& r = settings_.position;
  const Eigen::Vector3d force =
      now_.force + part * (now_.force - before_.force) - acceleration.cross(r) - rate.cross(rate.cross(r));
  return HullMotion{{-force.x(), -force.z()}, rate.y(), acceleration.y()};
}

}  // namespace hammer_loads
