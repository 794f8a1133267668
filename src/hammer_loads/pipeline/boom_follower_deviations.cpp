// Deviations of what the boom carries, and what they take for an error.
#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/boom_follower.h"

namespace hammer_loads {
namespace {

constexpr double kUnexplainedMemory = 1.0;  // [s]

}  // namespace

/// What hammer and oil as given do not make of the hull's acceleration is a force on its mass.
void BoomFollower::weighUnexplained(const ImuReading& reading, double step) noexcept {
  const ModeIdentifier& identifier = *boom_.vibration().identifier();
  state_.contact_unknown = !identifier.explains() && identifier.learns() && !identifier.followsContact();
  if (identifier.followsContact() || !std::isfinite(state_.reduced.mass)) return;
  const double felt = reading.specific_force.z() + boom_.gravityAtTip().z();
  const double explained = boom_.tipJacobian().row(2).dot(boom_.vibration().acceleration());
  const double force = state_.reduced.mass * (felt - explained);
  unexplained_ += std::clamp(step / kUnexplainedMemory, 0.0, 1.0) * (force * force - unexplained_);
}

/// A rock that is not measured is an error of the load, as large as what shows of it.
WrenchSpread BoomFollower::spreadWithRock(const WrenchSpread& of_crank) const noexcept {
  WrenchSpread spread = of_crank;
  if (!state_.contact_unknown || of_crank.count == 0) return spread;
  const double force = std::sqrt(unexplained_);
  spread.part[static_cast<std::size_t>(spread.count++)] = onTip({0.0, force, striking_distance_ * force});
  return spread;
}

/// Of what is measured the error is the measurement's: whatever the vibration's is, the contact makes up for it.
void BoomFollower::findDeviations(const WrenchSpread& spread, bool rigid) noexcept {
  BoomDeviations& deviations = state_.deviations;
  const Wrench lasting = pressuresCount() ? trust_.notOfRock(striking_distance_, least_contact_) : Wrench{};
  if (tip_) {
    boom_.deviations(measuredErrors(lasting, rigid), deviations);
  } else if (spread.count > 0 && boom_.vibration().followsReadings()) {
    boom_.deviations(followedErrors(spread, rigid), deviations);
  } else if (spread.count > 0) {
    boom_.deviations(spread_, spread, rigid, deviations);
  }
  if (!pressuresCount()) return;
  const JointVector lasting_torque = boom_.hammerTorque(lasting);
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    const std::optional<MeasuredTorques::Torque>& torque = measured_.of(i);
    if (!torque) continue;
    const int joint = boom_.cylinders()[i].joint();
    deviations.torque[joint] = std::hypot(torque->deviation, lasting_torque[joint]);
    deviations.cylinder[i] = deviations.torque[joint] / std::abs(boom_.cylinderPosition(i).arm);
  }
}

LoadErrors BoomFollower::measuredErrors(const Wrench& lasting, bool rigid) const noexcept {
  LoadErrors errors;
  const JointVector zero = JointVector::Zero(boom_.chain().joints());
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    JointVector torque = zero;
    torque[boom_.cylinders()[i].joint()] = measured_.of(i)->deviation;
    errors.add(zero, tip_->load(torque));
  }
  errors.add(zero, lasting);
  if (rigid || !boom_.vibration().known()) return errors;
  const JointMatrix of_vibration = boom_.vibration().identifier()->accelerationSpread();
  for (const auto& mode : of_vibration.colwise())
    errors.add(mode, tip_->load(boom_.vibration().modes().mass.lazyProduct(mode)));
  return errors;
}

LoadErrors BoomFollower::followedErrors(const WrenchSpread& spread, bool rigid) const noexcept {
  LoadErrors errors;
  const JointVector zero = JointVector::Zero(boom_.chain().joints());
  for (int i = 0; i < spread.count; ++i) errors.add(zero, spread.part[static_cast<std::size_t>(i)]);
  if (rigid) return errors;
  const JointMatrix of_vibration = boom_.vibration().identifier()->accelerationSpread();
  for (const auto& mode : of_vibration.colwise()) errors.add(mode, {});
  return errors;
}

}  // namespace hammer_loads
