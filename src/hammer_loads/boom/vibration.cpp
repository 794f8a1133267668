#include "hammer_loads/boom/vibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kSmall = 0.1;  // [rad]
// Limit: kSmall
constexpr double kOilStep = 0.003;  // change of the log stiffness after which the modes are computed again
// Numerical: kOilStep
constexpr double kMostOil = ModeIdentifier::kMostOil;

}  // namespace

Vibration::Vibration(const Chain& chain, std::vector<Cylinder> cylinders, const VibrationSettings& settings)
    : mass_(chain),
      cylinders_(std::move(cylinders)),
      settings_(settings),
      position_(JointVector::Zero(chain.joints())),
      last_(position_),
      torque_(last_) {
  for (std::size_t i = 0; i < cylinders_.size(); ++i)
    own_oil_[static_cast<Eigen::Index>(i)] = cylinders_[i].parameters().stiffness_std;
  modes_.mass = JointMatrix::Zero(chain.joints(), chain.joints());
  modes_.inertia.resize(chain.joints(), 0);
  reset();
}

void Vibration::setPose(const JointVector& position, const Eigen::Vector3d& g_B) noexcept {
  const JointVector middle = posed_ ? JointVector(0.5 * (last_ + position)) : position;
  const double step = posed_ ? (position - last_).cwiseAbs().maxCoeff() : 0.0;
  last_ = position;
  const JointVector away = middle - position_;
  const double farthest = away.cwiseAbs().maxCoeff();
  const LogOil stiffer = oilToTake();
  if (posed_ && farthest <= 0.5 * settings_.refresh_angle && stiffer.isZero(0.0)) return;
  const bool kept = posed_ && known();
  const JointVector displacement = jointsOf(modes_, x_), velocity = jointsOf(modes_, v_);
  // Ahead of a moving boom, so that the errors of the modes cancel on average and phases do not drift.
  position_ = middle;
  if (posed_ && farthest > 0.0) position_ += 0.5 * std::max(0.0, settings_.refresh_angle - step) / farthest * away;
  if (!position_.allFinite()) position_ = position;
  log_oil_ += stiffer;
  findModes(mass_, cylinders_, position_, g_B, log_oil_, modes_);
  if (contact_by_newton_.size() != modes_.count) contact_by_newton_.setZero(modes_.count);
  if (swing_.size() != modes_.count) swing_.setZero(modes_.count);
  posed_ = true;
  if (identifier_) identifier_->setModes(modes_, identifier_->forgets() ? LogOil(LogOil::Zero()) : stiffer);
  useIdentified();
  force_ = modalForce(modes_, torque_);
  if (kept) {
    x_ = modalOf(modes_, displacement);
    v_ = modalOf(modes_, velocity);
  } else {
    x_.setZero(modes_.count), v_.setZero(modes_.count);
  }
}

/// Logarithm of the stiffness for which the modes are computed. The shapes and the weight's share are right only with
/// the right stiffness, which then holds at any pose.
LogOil Vibration::oilToTake() const noexcept {
  const LogOil none = LogOil::Zero();
  if (!identifies() || !known()) return none;
  if (identifier_->forgets()) return -log_oil_;
  if (!identifier_->identified() && !identifier_->seeks()) return none;
  const LogOil found = identifier_->oil();
  if (!(found.cwiseAbs().maxCoeff() > kOilStep)) return none;
  return (log_oil_ + found).cwiseMax(-kMostOil).cwiseMin(kMostOil) - log_oil_;
}

void Vibration::reset() noexcept {
  x_.setZero(modes_.count);
  v_.setZero(modes_.count);
  torque_.setZero();
  force_.setZero(modes_.count);
  contact_ = mean_contact_ = 0.0;
  follows_readings_ = false;
  if (identifier_) identifier_->forgetMotion(usualSwing());
  posed_ = false;
}

void Vibration::startAnew() noexcept {
  if (identifier_) identifier_.emplace(settings_.damping_ratio, identifier_->learns(), own_oil_);
  log_oil_.setZero();
  swing_.setZero();
  reset();
}

void Vibration::advance(double step, const TorqueStep& torque) noexcept {
  const TorqueStep modal = modalForces(modes_, torque);
  if (identifier_) identifier_->advance(step, modal);
  for (int k = 0; k < modes_.count && !follows_readings_; ++k) {
    const double rock = contactAtLoad(k);
    const ModeForce force{modal.from[k] + rock, modal.to[k] + rock, modal.mean[k] + rock};
    const ModeState next =
        advanced(step_[static_cast<std::size_t>(k)].at(mode(k), step), {x_[k], v_[k]}, pathOf(force, step));
    x_[k] = next.x;
    v_[k] = next.v;
  }
  torque_ = torque.to;
  force_ = modal.to;
  if (follows_readings_) storeMotion();
  if (identifier_)
    mean_contact_ += std::min(1.0, step / look_back::kSomeTurns) * (identifier_->contact() - mean_contact_);
  restIfNotFinite();
  followSwing(step);
}

/// Mean of displacement and velocity, which take turns.
void Vibration::followSwing(double step) noexcept {
  const double share = std::min(1.0, step / kSwingTime);
  for (int k = 0; k < modes_.count; ++k) {
    const double next = swing_[k] + share * (0.5 * (square(x_[k]) + square(v_[k] / modes_.omega[k])) - swing_[k]);
    swing_[k] = std::isfinite(next) ? next : 0.0;
  }
}

void Vibration::strike(const JointVector& impulse) noexcept {
  if (identifier_) identifier_->strike(impulse);
  if (follows_readings_) {
    storeMotion();
  } else {
    v_ += modalForce(modes_, impulse);
  }
  restIfNotFinite();
}

void Vibration::observe(const VibrationReading* readings, std::size_t count) noexcept {
  if (!identifier_ || count == 0) return;
  identifier_->observe(readings, count);
  useIdentified();
  useMotion();
}

void Vibration::followContact(const JointVector& torque, double least_force) noexcept {
  if (!identifier_) {
    identifier_.emplace(settings_.damping_ratio, false, own_oil_);
    identifier_->setModes(modes_);
  }
  identifier_->followContact(torque);
  contact_by_newton_ = modalForce(modes_, torque);
  least_contact_ = least_force;
}

void Vibration::leaveContact() noexcept {
  contact_ = mean_contact_ = 0.0;
  if (!identifier_) return;
  identifier_->leaveContact();
  follows_readings_ = follows_readings_ && identifier_->learns();
}

/// Judges contact by the mean of the rock's force. A landing acts at once, but only the mean shows whether the hull
/// stands on rock. If it does not, the mean is an error of the motion's forces and is subtracted; otherwise a hull in
/// the air would carry a load.
void Vibration::useMotion() noexcept {
  const bool bears = identifier_->followsContact() && mean_contact_ > least_contact_;
  identifier_->bear(bears);
  follows_readings_ = bears || (identifier_->learns() && identifier_->explains() && identifier_->identified());
  contact_ = bears ? identifier_->contact() : follows_readings_ ? mean_contact_ : 0.0;
  if (follows_readings_) storeMotion();
}

void Vibration::storeMotion() noexcept {
  for (int k = 0; k < modes_.count; ++k) {
    const ModeState seen = identifier_->motion(k);
    x_[k] = seen.x, v_[k] = seen.v;
  }
}

void Vibration::useIdentified() noexcept {
  if (!identifier_) return;
  for (int k = 0; k < modes_.count; ++k) modes_.omega[k] = modes_.given_omega[k] * identifier_->frequencyRatio(k);
}

/// Uncertainty of a logarithm of stiffness by damping that is not the oil's. Such damping belongs to no single mode,
/// and the part of its force, 2 zeta of the stiffness's, that is in phase with the stiffness's is not known.
double Vibration::oilDeviation(int cylinder) const noexcept {
  double excess = 0.0;
  for (int k = 0; k < modes_.count; ++k)
    excess += modes_.oil_share(cylinder, k) * std::max(0.0, mode(k).zeta - settings_.damping_ratio);
  return excess;
}

Vibration::IdentifiedOil Vibration::identifiedOil(const LogOil& by) const noexcept {
  double variance = 0.0;
  for (int i = 0; i < modes_.count; ++i) {
    for (int j = 0; j < modes_.count; ++j) variance += by[i] * by[j] * identifier_->oilCovariance(i, j);
    variance += square(by[i] * oilDeviation(i));
  }
  return {by.dot(log_oil_ + identifier_->oil()), std::sqrt(std::max(variance, 0.0))};
}

std::optional<Vibration::IdentifiedOil> Vibration::identifiedOil(std::size_t cylinder) const noexcept {
  const int own = static_cast<int>(cylinder);
  if (!identifies() || own >= modes_.count || !identifier_->identified()) return std::nullopt;
  return identifiedOil(LogOil(LogOil::Unit(own)));
}

std::optional<Vibration::OilAgainstOthers> Vibration::oilAgainstOthers(std::size_t cylinder) const noexcept {
  const int count = modes_.count, own = static_cast<int>(cylinder);
  if (!identifies() || count < 2 || own >= count || !identifier_->identified()) return std::nullopt;
  LogOil by = LogOil::Zero();
  by.head(count).setConstant(-1.0 / (count - 1));
  by[own] = 1.0;
  const IdentifiedOil found = identifiedOil(by);
  return OilAgainstOthers{found.stiffer, found.deviation, by.cwiseProduct(own_oil_).norm()};
}

void Vibration::restIfNotFinite() noexcept {
  if (x_.allFinite() && v_.allFinite() && torque_.allFinite()) return;
  reset();
}

JointVector Vibration::displacement() const noexcept { return jointsOf(modes_, x_); }

JointVector Vibration::velocity() const noexcept { return jointsOf(modes_, v_); }

JointVector Vibration::displacementAfter(double step) const noexcept {
  JointVector q = jointsOf(modes_, x_ + std::clamp(step, 0.0, look_back::kLine) * v_);
  bool small = true;
  for (Eigen::Index j = 0; j < q.size(); ++j) small = small && std::abs(q[j]) < kSmall;
  if (!small) q.setZero();
  return q;
}

JointVector Vibration::acceleration() const noexcept { return jointsOf(modes_, modalAcceleration()); }

JointVector Vibration::torque() const noexcept { return -modes_.inertia.lazyProduct(modalAcceleration()); }

double Vibration::energy() const noexcept {
  return 0.5 * (v_.squaredNorm() + x_.cwiseProduct(modes_.omega).squaredNorm());
}

JointVector Vibration::modalAcceleration() const noexcept {
  JointVector result(modes_.count);
  for (int k = 0; k < modes_.count; ++k)
    result[k] = hammer_loads::acceleration(mode(k), {x_[k], v_[k]}, force_[k] + contactAtLoad(k));
  return result;
}

Vibration::OilTorque Vibration::oilTorque() const noexcept {
  JointVector now(modes_.count), rate(modes_.count);
  const bool seen = identifier_ && identifier_->followsContact();
  for (int k = 0; k < modes_.count; ++k) {
    const Mode m = mode(k);
    const ModeState s = seen ? identifier_->motion(k) : ModeState{x_[k], v_[k]};
    const double rock = (seen ? identifier_->contact() : contact_) * contact_by_newton_[k];
    const double a = hammer_loads::acceleration(m, s, force_[k] + rock);
    const double stiff = m.omega * m.omega, damped = 2.0 * m.zeta * m.omega;
    now[k] = stiff * s.x + damped * s.v, rate[k] = stiff * s.v + damped * a;
  }
  return {modes_.inertia.lazyProduct(now), modes_.inertia.lazyProduct(rate)};
}

JointVector Vibration::oilTorqueRead(double ahead) const noexcept {
  const bool late = identifier_ && identifier_->delay(Clock::kPressures) != 0.0;
  if (!late && !(identifier_ && identifier_->followsContact())) {
    const OilTorque torque = oilTorque();
    return torque.now + ahead * torque.rate;
  }
  JointVector modal(modes_.count);
  for (int k = 0; k < modes_.count; ++k) modal[k] = identifier_->oilTorqueRead(k, ahead);
  return modes_.inertia.lazyProduct(modal);
}

}  // namespace hammer_loads
