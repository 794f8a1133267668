#include "hammer_loads/pipeline/held_pose.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kMemory = 0.5, kLost = 0.5;  // of each filter [s]; of an angle that winds or came back [rad]
constexpr double kFast = 0.05, kRest = 2.0;   // [rad/s]: its acceleration hides the vibration; [s] to wait then
constexpr double kStart = 1.0;                // [s] until a boom that is driven at the start is seen to be

}  // namespace

void HeldPose::follow(const JointMotion& measured, double step) noexcept {
  motion_ = measured;
  const bool lost = first_.size() != measured.position.size() || !(step < kMemory) ||
                    (measured.position - first_).cwiseAbs().maxCoeff() > kLost;
  if (lost) {
    first_ = slow_ = slowest_ = measured.position;
    unrest_ = kStart;
    return;
  }
  const double part = step / kMemory;
  first_ += part * (measured.position - first_);
  slow_ += part * (first_ - slow_);
  slowest_ += part * (slow_ - slowest_);
  unrest_ = slowRate().cwiseAbs().maxCoeff() > kFast ? kRest : std::max(0.0, unrest_ - step);
  if (isDriven()) return;
  motion_.position = 3.0 * (first_ - slow_) + slowest_;
  motion_.velocity = slowRate();
}

JointVector HeldPose::slowRate() const noexcept { return (first_ - slow_) / kMemory; }

}  // namespace hammer_loads
