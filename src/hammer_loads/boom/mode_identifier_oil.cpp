// Identified properties of the oil: stiffness of the cylinders, frequencies and damping of the modes, and their forces.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kRubbed = 0.2;                          // log damping over the given one beyond which seals rub
constexpr double kKnown = 0.03;                          // deviation of log frequency of a mode that is known
constexpr double kMostEarly = 0.004, kMostLate = 0.012;  // [s]
// Prior: kMostEarly, kMostLate

}  // namespace

double ModeIdentifier::frequencyVariance(int mode) const noexcept {
  double variance = 0.0;
  for (int i = 0; i < count_; ++i)
    for (int j = 0; j < count_; ++j)
      variance += 0.25 * modes_.oil_share(i, mode) * modes_.oil_share(j, mode) * oilCovariance(i, j);
  return std::max(variance, 0.0);
}

/// Over the given one.
double ModeIdentifier::logFrequency(int mode) const noexcept {
  double sum = 0.0;
  for (int i = 0; i < count_; ++i) sum += 0.5 * modes_.oil_share(i, mode) * state_[at(i, kOil)];
  return sum;
}

double ModeIdentifier::dampingVariance(int mode) const noexcept {
  return covariance_(at(mode, kDamping), at(mode, kDamping));
}

bool ModeIdentifier::identified() const noexcept {
  for (int k = 0; k < count_; ++k) {
    if (!(frequencyVariance(k) < square(kKnown))) return false;
  }
  return count_ > 0;
}

LogOil ModeIdentifier::oil() const noexcept {
  LogOil oil = LogOil::Zero();
  for (int i = 0; i < count_; ++i) oil[i] = state_[at(i, kOil)];
  return oil;
}

void ModeIdentifier::forgetOil() noexcept {
  forget(kDelays, 0.0), forget(kDelays + 1, 0.0);
  known_for_ = lost_for_ = unlearns_for_ = crank_lead_ = 0.0;
  for (int k = 0; k < kMaxJoints; ++k) {
    forget(at(k, kOil), 0.0);
    forget(at(k, kDamping), 0.0);
  }
  stiffness_ratio_.setOnes(), used_oil_.setZero();
  ratio_.fill(1.0), used_frequency_.fill(0.0);
  damping_.fill(damping_ratio_), used_damping_.fill(0.0);
  for (const int rubs : rubbing_at_)
    if (rubs >= 0) forget(rubs, 1.0);
  setFirstGuesses();
}

/// Clamps stiffnesses, damping and delay of the state to their bounds.
void ModeIdentifier::useOil() noexcept {
  for (int k = 0; k < count_; ++k) {
    double& oil = state_[at(k, kOil)];
    oil = std::clamp(oil, -kMostOil, kMostOil);
    stiffness_ratio_[k] *= growth(oil - used_oil_[k]), used_oil_[k] = oil;
  }
  for (int k = 0; k < count_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    double& damping = state_[at(k, kDamping)];
    damping = std::clamp(damping, least_damping_, most_damping_);
    const double frequency = logFrequency(k);
    ratio_[i] *= growth(frequency - used_frequency_[i]), used_frequency_[i] = frequency;
    damping_[i] *= growth(damping - used_damping_[i]), used_damping_[i] = damping;
  }
  for (std::size_t i = 0; i < rubbing_at_.size(); ++i) {
    if (rubbing_at_[i] < 0 || !(seals_[i].deviation > 0.0)) continue;
    double& rubs = state_[rubbing_at_[i]];
    rubs = std::max(rubs, -seals_[i].known / seals_[i].deviation);  // friction does not drive
  }
  for (int i : {kDelays, kDelays + 1}) state_[i] = std::clamp(state_[i], -kMostEarly, kMostLate);
}

/// Mean square over an oscillation of a mode's acceleration by damping that is not the oil's.
double ModeIdentifier::varianceWithoutOil(int k) const noexcept {
  const Mode mode = modeAt(k);
  const ModeState now = stateOf(k);
  return 0.5 * square(2.0 * std::max(0.0, mode.zeta - damping_ratio_) * mode.omega) *
         (square(now.v) + square(mode.omega * now.x));
}

double ModeIdentifier::dampingWithoutOil(std::size_t cylinder) const noexcept {
  double squares = 0.0;
  for (int k = 0; k < count_; ++k) squares += square(modes_.inertia(modes_.joint[cylinder], k)) * varianceWithoutOil(k);
  return std::sqrt(squares);
}

ModeIdentifier::States ModeIdentifier::statesNow() const noexcept {
  States now;
  for (int k = 0; k < count_; ++k) now[static_cast<std::size_t>(k)] = stateOf(k);
  return now;
}

/// Wrong stiffnesses look like friction: it is estimated once the frequencies are known and a mode is clearly damped
/// more than given. Without an IMU, the stiffnesses and damping that were found before count as less known then.
void ModeIdentifier::setSeals(std::size_t cylinder, const Seals& seals) noexcept {
  seals_[cylinder] = seals;
  int& rubs = rubbing_at_[cylinder];
  if (!learns_ || rubs >= 0 || !(seals.deviation > 0.0)) return;
  if (!identified()) return;
  bool damped = false;
  for (int k = 0; k < count_; ++k) damped = damped || state_[at(k, kDamping)] > kRubbed + 2.0 * dampingDeviation(k);
  if (!damped) return;
  rubs = kSlots - ++used_slots_;
  forget(rubs, 1.0);
  if (!imuSpeaks()) unlearn(1.0 / count_);
}

/// A friction that is smaller than its remaining error counts less.
Seals ModeIdentifier::withIdentified(std::size_t cylinder, Seals seals) const noexcept {
  const int rubs = rubbing_at_[cylinder];
  if (rubs < 0) return seals;
  const double found = state_[rubs], left = square(kLeftRubbing);
  seals.known += seals.deviation * found * square(found) / (square(found) + left);
  seals.deviation *= std::min(1.0, std::sqrt(covariance_(rubs, rubs) + left));
  return seals;
}

LogOil ModeIdentifier::wayOfSeals(double ahead) const noexcept {
  LogOil way = LogOil::Zero();
  for (int i = 0; i < count_; ++i) {
    double rate = 0.0;
    for (int k = 0; k < count_; ++k) rate += modes_.shape(i, k) * state_[at(k, kV)];
    way[i] = seals_[static_cast<std::size_t>(i)].wayAfter(way_[i], rate, ahead);
  }
  return way;
}

LogOil ModeIdentifier::sealTorques(const LogOil& way) const noexcept {
  LogOil torque = LogOil::Zero();
  for (int i = 0; i < count_; ++i)
    if (rubbing_at_[static_cast<std::size_t>(i)] >= 0)
      torque[i] = seals_[static_cast<std::size_t>(i)].deviation * way[i];
  return torque;
}

/// Modal force of the seals against the joints' motion.
ModeVector ModeIdentifier::forceOfSeals(const LogOil& way) const noexcept {
  ModeVector force = ModeVector::Zero();
  for (int i = 0; i < count_; ++i) {
    const auto cylinder = static_cast<std::size_t>(i);
    const double torque = way[i] * withIdentified(cylinder, seals_[cylinder]).known;
    for (int k = 0; k < count_; ++k) force[k] -= modes_.shape(i, k) * torque;
  }
  return force;
}

/// Derivatives of the oil's torques on the joints by the logarithms of stiffness [N m].
LogOil ModeIdentifier::oilTorques(const States& of) const noexcept {
  LogOil torque = LogOil::Zero();
  for (int i = 0; i < count_; ++i) {
    for (int k = 0; k < count_; ++k) torque[i] += modes_.shape(i, k) * of[static_cast<std::size_t>(k)].x;
    torque[i] *= modes_.stiffness[i] * stiffness_ratio_[i];
  }
  return torque;
}

JointMatrix ModeIdentifier::accelerationCovariance() const noexcept {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 + kParts * kMaxJoints, kMaxJoints>;
  const int states = end() - kContact, kept = kModes - kContact;
  Rows rows = Rows::Zero(states, count_);  // a mode's acceleration by the states from the rock's force on
  const LogOil torque = oilTorques(statesNow());
  for (int k = 0; k < count_; ++k) {
    const Mode m = modeAt(k);
    const ModeState s = stateOf(k);
    const double damped = 2.0 * m.zeta * m.omega;
    const int own = kept + kParts * k;
    rows(0, k) = contact_[k];
    rows(own + kX, k) = -m.omega * m.omega, rows(own + kV, k) = -damped, rows(own + kDamping, k) = -damped * s.v;
    for (int i = 0; i < count_; ++i)
      rows(kept + kParts * i + kOil, k) = -modes_.shape(i, k) * torque[i] - 0.5 * modes_.oil_share(i, k) * damped * s.v;
  }
  LogOil unknown = LogOil::Zero();  // standard deviation of each cylinder's friction [N m]
  for (int i = 0; i < count_; ++i) {
    const auto cylinder = static_cast<std::size_t>(i);
    unknown[i] = withIdentified(cylinder, seals_[cylinder]).deviation;
  }
  JointMatrix covariance(count_, count_);
  for (int k = 0; k < count_; ++k) {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 + kParts * kMaxJoints, 1> with;  // covariance of all with a mode's
    with.noalias() = covariance_.block(kContact, kContact, states, states) * rows.col(k);
    for (int l = 0; l <= k; ++l) covariance(k, l) = covariance(l, k) = rows.col(l).dot(with);
    const Mode m = modeAt(k);
    const ModeState s = stateOf(k);
    for (int i = 0; i < count_; ++i) covariance(k, k) += square(modes_.shape(i, k) * way_[i] * unknown[i]);
    // The first term is that of damping by neither oil nor known friction, which is not linear and not of a single
    // mode; the others are those of errors of the mode's shape.
    covariance(k, k) += varianceWithoutOil(k) + square(2.0 * kLeftFrequency * m.omega * m.omega * s.x) +
                        square(kLeftDamping * 2.0 * m.zeta * m.omega * s.v);
  }
  return covariance;
}

}  // namespace hammer_loads
