// Standard deviations of the boom's loads, and their error sources.
#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

void addVariance(double other, double& deviation) noexcept { deviation = std::sqrt(square(deviation) + square(other)); }

void addVariance(const Wrench& other, Wrench& deviation) noexcept {
  for (int i = 0; i < 3; ++i) {
    addVariance(other.force[i], deviation.force[i]);
    addVariance(other.torque[i], deviation.torque[i]);
  }
}

template <typename List>
void addVariances(const List& others, std::size_t count, List& deviations) noexcept {
  for (std::size_t i = 0; i < count; ++i) addVariance(others[i], deviations[i]);
}

}  // namespace

Eigen::Matrix3d BoomFollower::tipCovariance() const noexcept {
  const BoomModes& modes = boom_.vibration().modes();
  const std::optional<ModeIdentifier>& identifier = boom_.vibration().identifier();
  if (modes.count == 0 || !state_.choice.compliant) return Eigen::Matrix3d::Zero();
  if (!spread_.waits()) return tipCovarianceAsGiven();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxJoints> by_mode(3, modes.count);
  for (int row = 0; row < 3; ++row)
    by_mode.row(row) = modalForce(modes, boom_.tipJacobian().row(2 * row).transpose()).transpose();
  JointMatrix of_modes = std::max(1.0, identifier->oilInnovationRatio()) * identifier->accelerationCovariance();
  if (state_.useless) {  // the vibration is as uncertain as its torques
    const JointVector usual = boom_.vibration().usualSwing().cwiseProduct(modes.omega.cwiseAbs2());
    of_modes.diagonal() += square(std::min(1.0, worth_.ratio())) * usual.cwiseAbs2();
  }
  return by_mode * of_modes * by_mode.transpose();
}

/// Returns the covariance due to stiffness and damping of the oil and to errors of the hammer's load.
Eigen::Matrix3d BoomFollower::tipCovarianceAsGiven() const noexcept {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  const JointVector vibration = boom_.vibration().acceleration();
  const auto ofTip = [&](const JointVector& joints) {
    const Eigen::Matrix<double, 6, 1> tip = boom_.tipJacobian() * joints;
    return Eigen::Vector3d(tip[0], tip[2], tip[4]);
  };
  const auto ofRun = [&](int run) { return ofTip(spread_.accelerationDifference(run, vibration)); };
  const auto add = [&](const Eigen::Vector3d& error) { covariance += error * error.transpose(); };
  const Eigen::Vector3d stiffer = ofRun(VibrationSpread::kStiffer), softer = ofRun(VibrationSpread::kSofter);
  add(stiffer.head<2>().squaredNorm() > softer.head<2>().squaredNorm() ? stiffer : softer);
  for (int run = VibrationSpread::kDamped; run < spread_.runs(); ++run) add(ofRun(run));
  for (int k = 0; spread_.startsUnknown() && k < spread_.modes(); ++k) add(ofTip(spread_.accelerationOfSwing(k)));
  return covariance;
}

/// Attributes the part of the hull's acceleration that hammer and oil do not explain to a force on its mass.
void BoomFollower::learnUnexplained(const ImuReading& reading, double step) noexcept {
  const ModeIdentifier& identifier = *boom_.vibration().identifier();
  state_.contact_unknown = !identifier.explains() && identifier.learns() && !identifier.followsContact();
  if (identifier.followsContact() || !std::isfinite(state_.reduced.mass)) return;
  const double felt = reading.specific_force.z() + boom_.gravityAtTip().z();
  const double explained = boom_.tipJacobian().row(2).dot(boom_.vibration().acceleration());
  const double force = state_.reduced.mass * (felt - explained);
  unexplained_ += std::clamp(step / Vibration::kSwingTime, 0.0, 1.0) * (force * force - unexplained_);
}

/// Adds an unmeasured force of the rock as an error of the load, with the magnitude that the residuals show.
WrenchSpread BoomFollower::spreadWithRock(const WrenchSpread& of_crank) const noexcept {
  WrenchSpread spread = of_crank;
  if (!state_.contact_unknown || of_crank.count == 0) return spread;
  const double force = std::sqrt(unexplained_);
  spread.part[static_cast<std::size_t>(spread.count++)] = onTip({0.0, force, striking_distance_ * force});
  return spread;
}

/// Finds the standard deviations. Measured loads have those of the measurement, since the contact load compensates an
/// error of the vibration.
void BoomFollower::findDeviations(const WrenchSpread& spread, bool rigid) noexcept {
  BoomDeviations& deviations = state_.deviations;
  const Wrench lasting = pressuresCount() ? trust_.notOfRock(striking_distance_, least_contact_) : Wrench{};
  const Known known = source();
  if (known == Known::kMeasured) {
    boom_.deviations(measuredErrors(lasting, rigid), deviations);
  } else if (spread.count > 0 && known == Known::kFollowed) {
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
    deviations.torque[joint] =
        std::sqrt(square(torque->deviation) + square(torque->constant) + square(lasting_torque[joint]));
    deviations.cylinder[i] = deviations.torque[joint] / std::abs(boom_.cylinderPosition(i).arm);
  }
}

/// Adds errors of constants as static loads, without the amplification or attenuation by the boom's modes. They do not
/// enter measured loads.
void BoomFollower::addConstants(const BoomSample& sample) noexcept {
  const bool known = sample.spread.count > 0;
  const auto of = [&](const Eigen::Matrix3d& errors) {
    boom_.deviations(source() == Known::kMeasured ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : errors, state_.common);
    for (std::size_t i = 0; pressuresCount() && i < boom_.cylinders().size(); ++i) {
      if (measured_.of(i)) state_.common.torque[boom_.cylinders()[i].joint()] = state_.common.cylinder[i] = 0.0;
    }
  };
  if (known && !sample.of_hammer.isZero(0.0)) {
    of(sample.of_hammer);
    BoomDeviations& all = state_.deviations;
    for (Eigen::Index i = 0; i < all.torque.size(); ++i) addVariance(state_.common.torque[i], all.torque[i]);
    addVariances(state_.common.cylinder, boom_.cylinders().size(), all.cylinder);
    addVariances(state_.common.section, boom_.sections().size(), all.section);
    addVariances(state_.common.joint, static_cast<std::size_t>(boom_.chain().joints()), all.joint);
  }
  if (known) of(sample.constants);
  if (source() == Known::kFollowed && state_.choice.compliant) addBending();
  addConstantsOfBoom(known);
}

/// Adds the standard deviation due to bending where only an IMU shows the motion. Pressures would show the torques.
void BoomFollower::addBending() noexcept {
  const JointVector bending = boom_.bendingDeviation();
  BoomDeviations& all = state_.deviations;
  for (Eigen::Index i = 0; i < bending.size(); ++i) addVariance(bending[i], all.torque[i]);
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i)
    addVariance(bending[boom_.cylinders()[i].joint()] / std::abs(boom_.cylinderPosition(i).arm), all.cylinder[i]);
  for (std::size_t i = 0; i < boom_.sections().size(); ++i) {  // at most that of the joint before it
    int joint = 0;
    while (joint + 1 < bending.size() && boom_.chain().linkBeyond(joint + 1) <= boom_.sections()[i].link()) ++joint;
    addVariance(bending[joint], all.section[i].torque.y());
  }
}

/// Adds errors of the boom's constants. Unmeasured torques have errors of masses, centres and zeros. Measured torques
/// have errors of one-sided seal friction and of offsets, which their standard deviation contains already.
void BoomFollower::addConstantsOfBoom(bool common_known) noexcept {
  BoomDeviations &all = state_.deviations, &common = state_.common;
  JointVector unmeasured = boom_.weightDeviation(), lasting = unmeasured;
  for (std::size_t i = 0; pressuresCount() && i < boom_.cylinders().size(); ++i) {
    if (!measured_.of(i)) continue;
    unmeasured[boom_.cylinders()[i].joint()] = 0.0;
    lasting[boom_.cylinders()[i].joint()] = measured_.of(i)->lasting;
  }
  for (int j = 0; j < unmeasured.size(); ++j) {
    addVariance(unmeasured[j], all.torque[j]);
    if (common_known) addVariance(lasting[j], common.torque[j]);
  }
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    const int j = boom_.cylinders()[i].joint();
    const double arm = std::abs(boom_.cylinderPosition(i).arm);
    addVariance(unmeasured[j] / arm, all.cylinder[i]);
    if (common_known) addVariance(lasting[j] / arm, common.cylinder[i]);
  }
}

LoadErrors BoomFollower::measuredErrors(const Wrench& lasting, bool rigid) const noexcept {
  LoadErrors errors(boom_.cylinders());
  std::array<double, kMaxJoints> torque{};
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    double& one = torque[static_cast<std::size_t>(boom_.cylinders()[i].joint())];
    one = std::sqrt(square(measured_.of(i)->deviation) + square(measured_.of(i)->constant));
    errors.addInPlane(tip_->inPlane(torque));
    one = 0.0;
  }
  errors.addInPlane(inPlane(lasting));
  const BoomModes& modes = boom_.vibration().modes();
  if (rigid || modes.count == 0) return errors;
  std::array<Eigen::Vector3d, kMaxJoints> tip;
  for (int k = 0; k < modes.count; ++k) tip[static_cast<std::size_t>(k)] = tip_->inPlane(modes.inertia.col(k));
  errors.add(modes, boom_.vibration().identifier()->accelerationCovariance(), tip);
  return errors;
}

LoadErrors BoomFollower::followedErrors(const WrenchSpread& spread, bool rigid) const noexcept {
  LoadErrors errors(boom_.cylinders());
  for (int i = 0; i < spread.count; ++i) errors.addInPlane(inPlane(spread.part[static_cast<std::size_t>(i)]));
  if (rigid) return errors;
  std::array<Eigen::Vector3d, kMaxJoints> none;
  none.fill(Eigen::Vector3d::Zero());
  errors.add(boom_.vibration().modes(), boom_.vibration().identifier()->accelerationCovariance(), none);
  return errors;
}

}  // namespace hammer_loads
