#include "hammer_loads/pipeline/held_pose.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/util/functions.h"
#include "hammer_loads/util/known_count.h"

namespace hammer_loads {
namespace {

constexpr double kMemory = look_back::kSomeTurns;  // time constant of each filter
constexpr double kLost = 0.5;                      // jump of an angle that winds or came back [rad]
// Limit: kLost
constexpr double kFast = 0.05;    // [rad/s]: acceleration of a faster joint hides the vibration
constexpr double kSettles = 2.5;  // [s]: time for which a fast motion appears as an acceleration in the filters

}  // namespace

void HeldPose::follow(const JointMotion& measured, double step) noexcept {
  motion_ = measured;
  angle_ = measured.position;
  since_blow_ += step;
  const bool is_first = first_.size() != measured.position.size(), gap = !(step < kMemory);
  if (gap && !is_first && !isDriven()) goOn(step);
  const bool lost = is_first || !((measured.position - first_).cwiseAbs().maxCoeff() < kLost);
  if (lost) {
    first_ = slow_ = slowest_ = last_ = measured.position;
    unrest_ = look_back::kFiveTurns;
    at_blow_.resize(0), of_turn_.resize(0), of_turn_before_.resize(0);
    return;
  }
  const double part = gap ? 0.0 : step / kMemory;
  withCount<4>(static_cast<int>(first_.size()), [&](auto joints) {
    for (int j = 0; j < joints; ++j) {
      first_[j] += part * (angle_[j] - first_[j]);
      slow_[j] += part * (first_[j] - slow_[j]);
      slowest_[j] += part * (slow_[j] - slowest_[j]);
      last_[j] += part * (slowest_[j] - last_[j]);
    }
  });
  unrest_ = slowRate().cwiseAbs().maxCoeff() > kFast ? look_back::kTenTurns : std::max(0.0, unrest_ - step);
  settling_ = gap || isDriven() ? kSettles : std::max(0.0, settling_ - step);
  if (isDriven()) return;
  motion_.position = 3.0 * (first_ - slow_) + slowest_;
  motion_.velocity = slowRate();
  if (settling_ == 0.0) motion_.acceleration = slowAcceleration();
}

/// Extrapolates over a gap at the last rate of the operator's motion.
void HeldPose::goOn(double step) noexcept {
  const JointVector way = step * slowRate();
  for (JointVector* angle : {&first_, &slow_, &slowest_, &last_}) *angle += way;
}

void HeldPose::struck() noexcept {
  const bool turned = at_blow_.size() == angle_.size() && since_blow_ > 0.0 && since_blow_ < kLongestTurn;
  if (turned) {
    const JointVector rate = (angle_ - at_blow_) / since_blow_;
    of_turn_ = of_turn_before_.size() > 0 ? JointVector(1.5 * rate - 0.5 * of_turn_before_) : rate;
    of_turn_before_ = rate;
  } else {
    of_turn_.resize(0), of_turn_before_.resize(0);
  }
  at_blow_ = angle_, since_blow_ = 0.0;
}

JointVector HeldPose::slowRate() const noexcept { return (first_ - slow_) / kMemory; }

/// Returns the acceleration from three filters, extrapolated over their delay by the change seen in four filters.
JointVector HeldPose::slowAcceleration() const noexcept {
  const JointVector late = first_ - 2.0 * slow_ + slowest_, change = late - (slow_ - 2.0 * slowest_ + last_);
  return (late + 3.0 * change) / square(kMemory);
}

}  // namespace hammer_loads
