// The boom's motion and loads from sensors: readings, their plausibility, the rock's force.
#include <algorithm>

#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/hull_imu.h"

namespace hammer_loads {
namespace {

constexpr double kStillBeats = kLongestTurn;  // time after a blow within which the hammer may be at work [s]

}  // namespace

/// Discards frequencies, damping and motion that were estimated from wrong readings.
void BoomFollower::forgetWrongReadings(bool imu_lost) noexcept {
  const int lost = static_cast<int>(trust_.isLost()) + static_cast<int>(imu_lost);
  if (lost > lost_sensors_ && boom_.vibration().identifier()) {
    boom_.vibration().startAnew();
    known_ = false;
  }
  lost_sensors_ = lost;
}

/// Estimates the contact load where all pressures are known; without them its estimate would not change.
void BoomFollower::followContact(StampNs stamp) noexcept {
  bool measured = pressuresCount();
  for (std::size_t i = 0; i < boom_.cylinders().size() && measured; ++i) measured = pressures_.known(i, stamp);
  if (measured) {
    boom_.vibration().followContact(hammerTorque({0.0, 1.0, striking_distance_}), least_contact_);
  } else {
    boom_.vibration().leaveContact();
  }
}

/// Updates motion, frequencies and damping with the sensors' readings.
void BoomFollower::observe(const BoomSample& sample, double step) noexcept {
  if (!boom_.vibration().identifier()) return;
  if (trust_.isLate()) trust_.followDelay(0.0, 0.0, step);
  boom_.vibration().keepOil(!last_blow_ || seconds(sample.stamp - *last_blow_) > kStillBeats);
  if (sample.imu) {
    observer_.imu(boom_, held_, sample.stamp, step, *sample.imu);
    if (!state_.at_blow) learnUnexplained(sample.imu->reading, step);  // the reading may be from before the blow
  }
  observer_.joints(boom_, held_, sample.stamp, step, joints_);
  if (!pressuresCount()) return;
  observer_.pressures(boom_, held_, sample.stamp, pressures_);
  const ModeIdentifier& found = *boom_.vibration().identifier();
  trust_.followDelay(found.delay(Clock::kPressures), found.oilInnovationRatio(), step);
}

/// Attributes to the rock the difference between measured forces, which balance all loads, and the model.
void BoomFollower::updateMeasured(const BoomSample& sample, double step) noexcept {
  state_.contact_torque.setZero();
  state_.contact = {};
  state_.measured = state_.hold_down_force_lost = false;
  tip_.reset();
  if (pressures_.accepted() == 0) return;
  const BoomLoads& loads = state_.loads;
  measured_.follow(boom_, motion_.position, loads.weight + loads.motion, held_.motion().velocity,
                   {sample.stamp, sample.stamp_noise}, pressures_);
  std::size_t measured = 0;
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    const std::optional<MeasuredTorques::Torque>& torque = measured_.of(i);
    if (!torque) continue;
    const int joint = boom_.cylinders()[i].joint();
    state_.contact_torque[joint] = torque->value - loads.total[joint];
    ++measured;
  }
  state_.measured = measured > 0 && measured == boom_.cylinders().size();
  findContact(step);
  if (!trust_.isLost()) return useMeasured();
  state_.contact_torque.setZero();
  state_.contact = {};
  state_.measured = state_.hold_down_force_lost = false;
  tip_.reset();
}

void BoomFollower::useMeasured() noexcept {
  BoomLoads& loads = state_.loads;
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    const std::optional<MeasuredTorques::Torque>& torque = measured_.of(i);
    if (!torque) continue;
    loads.total[boom_.cylinders()[i].joint()] = torque->value;
    loads.cylinder[i] = boom_.cylinders()[i].load(torque->at, torque->value);
  }
}

/// Finds the contact load: three cylinders in a plane determine it, otherwise only the torques are known. A force below
/// its error counts as a lost hold-down force.
void BoomFollower::findContact(double step) noexcept {
  const auto& c = boom_.cylinders();
  if (!state_.measured || c.size() != 3) return;
  tip_.emplace(boom_.tipJacobian(), std::array<int, 3>{c[0].joint(), c[1].joint(), c[2].joint()});
  if (!tip_->isKnown()) return tip_.reset();
  state_.contact = tip_->load(state_.contact_torque);
  trust_.follow(state_.contact, tip_->load(state_.loads.weight), striking_distance_, step);
  const auto& observer = boom_.vibration().identifier();
  const double error = observer && observer->followsContact() ? observer->contactDeviation() : 0.0;
  state_.hold_down_force_lost = state_.contact.force.z() < std::max(least_contact_, error);
}

}  // namespace hammer_loads
