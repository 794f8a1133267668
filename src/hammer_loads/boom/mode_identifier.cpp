#include "hammer_loads/boom/mode_identifier.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/known_count.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kCommonDeviation = 0.15;  // of log frequency, of all modes together
constexpr double kOwnDeviation = 0.05;     // and of each
constexpr double kDampingDeviation = 0.5;  // of log damping
constexpr double kFrequencyWalk = 0.002;   // of log frequency in a second: oil that warms up, a pose that changes
constexpr double kDampingWalk = 0.01;      // of log damping in a second
constexpr double kForcePart = 0.05;        // deviation of the modal force over its root mean square
constexpr double kForceTime = 0.01;        // for which a force stays wrong the same way [s]
constexpr double kForceMemory = 2.0;       // of the mean square [s]
constexpr double kUnknownRate = 0.05;      // joint velocity where nothing is known [rad/s]
constexpr double kContactWalk = 1.3e5;     // of the rock's force [N/sqrt(s)]
constexpr double kContactWalkSeen = 3e5;   // where an IMU shows each landing: they are no noise then
constexpr double kUnknownContact = 1e4;    // of it at the start [N]
constexpr double kLeastDamping = 2e-3, kMostDamping = 0.7;

}  // namespace

ModeIdentifier::ModeIdentifier(double damping_ratio, bool learns)
    : damping_ratio_(damping_ratio),
      least_damping_(std::log(kLeastDamping / damping_ratio)),
      most_damping_(std::log(kMostDamping / damping_ratio)),
      learns_(learns) {
  if (learns) setFirstGuesses();
  covariance_(kContact, kContact) = square(kUnknownContact);
  ratio_.fill(1.0);
  damping_.fill(damping_ratio);
  slot_.fill(-1);
}

void ModeIdentifier::setFirstGuesses() noexcept {
  for (int k = 0; k < kMaxJoints; ++k) {
    for (int l = 0; l < kMaxJoints; ++l)
      covariance_(at(k, kFrequency), at(l, kFrequency)) =
          square(kCommonDeviation) + (k == l ? square(kOwnDeviation) : 0);
    covariance_(at(k, kDamping), at(k, kDamping)) = square(kDampingDeviation);
  }
}

JointVector ModeIdentifier::displacement() const noexcept {
  JointVector x(count_);
  for (int k = 0; k < count_; ++k) x[k] = state_[at(k, kX)];
  return jointsOf(modes_, x);
}

JointVector ModeIdentifier::velocity() const noexcept {
  JointVector v(count_);
  for (int k = 0; k < count_; ++k) v[k] = state_[at(k, kV)];
  return jointsOf(modes_, v);
}

JointMatrix ModeIdentifier::accelerationCovariance() const noexcept {
  std::array<Eigen::Matrix<double, kParts, 1>, kMaxJoints> row;  // of a mode's acceleration
  JointMatrix covariance(count_, count_);
  for (int k = 0; k < count_; ++k) {
    const Mode m = modeAt(k);
    const ModeState s = stateOf(k);
    const double stiff = m.omega * m.omega, damped = 2.0 * m.zeta * m.omega;
    row[static_cast<std::size_t>(k)] << -stiff, -damped, -2.0 * stiff * s.x - damped * s.v, -damped * s.v;
  }
  for (int l = 0; l < count_; ++l) {
    const auto& by = row[static_cast<std::size_t>(l)];
    const int of_l = at(l, kX);
    const double with_contact =
        contact_[l] * covariance_(kContact, kContact) + covariance_.col(kContact).segment<kParts>(of_l).dot(by);
    for (int k = l; k < count_; ++k) {
      const int of_k = at(k, kX);
      const Eigen::Matrix<double, kParts, 1> with_mode = contact_[l] * covariance_.col(kContact).segment<kParts>(of_k) +
                                                         covariance_.block<kParts, kParts>(of_k, of_l) * by;
      covariance(k, l) = covariance(l, k) =
          contact_[k] * with_contact + row[static_cast<std::size_t>(k)].dot(with_mode);
    }
    // What the mode's shape lacks.
    const Mode m = modeAt(l);
    const ModeState s = stateOf(l);
    covariance(l, l) +=
        square(2.0 * kLeftFrequency * m.omega * m.omega * s.x) + square(kLeftDamping * 2.0 * m.zeta * m.omega * s.v);
  }
  return covariance;
}

void ModeIdentifier::setModes(const BoomModes& given, double stiffer) noexcept {
  const bool carries = moving_known_ && count_ == given.count;
  JointMatrix T(given.count, given.count);  // new modal displacements of the old ones, through the joints
  if (carries) {
    for (int k = 0; k < count_; ++k) {
      JointVector unit = JointVector::Zero(count_);
      unit[k] = 1.0;
      T.col(k) = modalOf(given, jointsOf(modes_, unit));
    }
  }
  if (count_ != given.count) history_ = ModeHistory();  // zero for modes that there are not
  modes_ = given;
  count_ = given.count;
  history_.clear();
  if (!carries) {
    forgetMotion();
  } else {
    transform(T);
  }
  if (stiffer == 0.0) return;
  for (int k = 0; k < count_; ++k) state_[at(k, kFrequency)] -= 0.5 * modes_.oil_share[k] * stiffer;
  useOil();
}

/// Displacements and velocities of the modes by T; frequencies, dampings and offsets stay.
void ModeIdentifier::transform(const JointMatrix& T) noexcept {
  const auto apply = [&](double* values, int stride) {  // in the states' order
    withCount<3>(count_, [&](auto count) {
      for (const Part part : {kX, kV}) {
        std::array<double, kMaxJoints> old;
        for (int k = 0; k < count; ++k) old[static_cast<std::size_t>(k)] = values[stride * at(k, part)];
        for (int k = 0; k < count; ++k) {
          double sum = 0.0;
          for (int l = 0; l < count; ++l) sum += T(k, l) * old[static_cast<std::size_t>(l)];
          values[stride * at(k, part)] = sum;
        }
      }
    });
  };
  apply(state_.data(), 1);
  for (int i = begin(); i < end(); ++i) apply(column(i), 1);
  for (int i = begin(); i < end(); ++i) apply(covariance_.data() + i, kMaxStates);
  force_.head(count_) = (T * force_.head(count_)).eval();
  force_rate_.head(count_) = (T * force_rate_.head(count_)).eval();
}

void ModeIdentifier::forget(int state, double deviation) noexcept {
  state_[state] = 0.0;
  covariance_.row(state).setZero();
  covariance_.col(state).setZero();
  covariance_(state, state) = square(deviation);
}

void ModeIdentifier::leaveContact() noexcept {
  bears_ = false;
  if (!follows_contact_) return;
  follows_contact_ = false;
  forget(kContact, kUnknownContact);
}

void ModeIdentifier::forgetMotion(const JointVector& swing) noexcept {
  moving_known_ = count_ > 0;
  history_.clear();
  force_.setZero(), force_rate_.setZero();
  forget(kContact, kUnknownContact);
  for (int k = 0; k < kMaxJoints; ++k) {
    for (Part part : {kX, kV}) {
      const int i = at(k, part);
      forget(i, 0.0);
      if (k >= count_) continue;
      const double omega = modeAt(k).omega, least = kUnknownRate / modes_.shape.col(k).cwiseAbs().maxCoeff();
      const double rate = k < swing.size() ? std::max(least, omega * swing[k]) : least;
      covariance_(i, i) = square(part == kV ? rate : rate / omega);
    }
  }
}

void ModeIdentifier::followContact(const JointVector& torque) noexcept {
  follows_contact_ = true;
  contact_.setZero();
  contact_.head(count_) = modalForce(modes_, torque);
}

void ModeIdentifier::advance(double step, const TorqueStep& modal) noexcept {
  if (!moving_known_ || !(step > 0.0)) return;
  const double share = std::min(1.0, step / kForceMemory);
  history_.begin(step);
  for (int k = 0; k < count_; ++k) {
    double& power = force_power_[static_cast<std::size_t>(k)];
    power += share * (square(modal.mean[k]) - power);
    advanceMode(k, step, {modal.from[k], modal.to[k], modal.mean[k]});
    walk(k, step);
  }
  force_.head(count_) = modal.to;
  force_rate_.head(count_) = (modal.to - modal.from) / step;
  for (double& age : age_) age += step;
  imu_age_ += step;
  free_for_ = follows_contact_ && !bears_ ? free_for_ + step : 0.0;
  if (follows_contact_) walkContact(step);
  advanceDelays(step);
  for (int i = begin(); i < end(); ++i) covariance_(i, i) = std::max(covariance_(i, i), 0.0);
  if (!finite()) startAnew();
}

/// One mode's state, and P <- F P F^T for its rows and columns. Frequency and damping act as forces that are linear
/// over the step: their derivatives are off by 3 % at 9 Hz and a step of 10 ms, the state itself is exact.
void ModeIdentifier::advanceMode(int mode, double step, const ModeForce& force) noexcept {
  const Mode here = modeAt(mode);
  const double rock = rockOn(mode);
  const ModeStep its = stepOf(here, step);
  const ModeResponse& r = its.r;
  const ModeState now = stateOf(mode);
  ModeState next = advanced(its, now, pathOf(force, step));
  next.x += r.step * rock * state_[kContact], next.v += r.impulse * rock * state_[kContact];

  const double stiff = here.omega * here.omega, damped = 2.0 * here.zeta * here.omega, per_time = 1.0 / step;
  const auto by = [&](double from, double to) {  // of a force
    const double slope = (to - from) * per_time;
    return ModeState{from * r.step + slope * r.ramp, from * r.impulse + slope * r.step};
  };
  const ModeState of_frequency = by(-2.0 * stiff * now.x - damped * now.v, -2.0 * stiff * next.x - damped * next.v),
                  of_damping = by(-damped * now.v, -damped * next.v);
  const int x = at(mode, kX);
  state_[x + kX] = next.x, state_[x + kV] = next.v;
  history_.set(mode, now, next, force.from, force.to);
  const int first = begin(), its_x = x - first;
  replaceTwo(block(), its_x, {its_x + kX, its_x + kV, its_x + kFrequency, its_x + kDamping, kContact - first},
             {its.x_by_x, its.x_by_v, of_frequency.x, of_damping.x, r.step * rock},
             {its.v_by_x, its.v_by_v, of_frequency.v, of_damping.v, r.impulse * rock});
}

/// P <- P + Q: forces that are wrong, oil that warms up.
void ModeIdentifier::walk(int mode, double step) noexcept {
  const int x = at(mode, kX);
  const double v_walk = square(kForcePart) * force_power_[static_cast<std::size_t>(mode)] * 2.0 * kForceTime * step;
  covariance_(x + kV, x + kV) += v_walk;
  covariance_(x + kX, x + kX) += v_walk * step * step / 3.0;
  if (!learns_) return;
  const auto wander = [&](int i, double per_second, double most) {
    if (covariance_(i, i) < most * most) covariance_(i, i) += square(per_second) * step;
  };
  wander(x + kFrequency, kFrequencyWalk, kCommonDeviation);
  wander(x + kDamping, kDampingWalk, kDampingDeviation);
}

/// The rock's force wanders within the step as well, and the modes' velocities with it.
void ModeIdentifier::walkContact(double step) noexcept {
  const double force = square(bears_ && imuSpeaks() ? kContactWalkSeen : kContactWalk) * step;
  covariance_(kContact, kContact) += force;
  for (int k = 0; k < count_; ++k) {
    const int x = at(k, kX), v = at(k, kV);
    covariance_(v, kContact) = covariance_(kContact, v) += contact_[k] * force * step / 2.0;
    covariance_(x, kContact) = covariance_(kContact, x) += contact_[k] * force * square(step) / 6.0;
    for (int l = 0; l < count_; ++l) {
      const double both = contact_[k] * contact_[l] * force * square(step);
      covariance_(v, at(l, kV)) += both / 3.0;
      covariance_(x, at(l, kV)) += both * step / 8.0, covariance_(at(l, kV), x) += both * step / 8.0;
      covariance_(x, at(l, kX)) += both * square(step) / 20.0;
    }
  }
}

void ModeIdentifier::strike(const JointVector& impulse) noexcept {
  if (!moving_known_) return;
  const JointVector jump = modalForce(modes_, impulse);
  for (int k = 0; k < count_; ++k) {
    state_[at(k, kV)] += jump[k];
    history_.strike(k, jump[k]);
    covariance_(at(k, kV), at(k, kV)) += square(kForcePart * jump[k]);
  }
}

/// What is not finite anywhere reaches the diagonal with the next step.
bool ModeIdentifier::finite() const noexcept {
  double sum = 0.0;
  for (int i = begin(); i < end(); ++i) sum += 0.0 * (state_[i] + covariance_(i, i));
  return sum == 0.0;
}

void ModeIdentifier::startAnew() noexcept {
  const BoomModes modes = modes_;
  const bool follows = follows_contact_;
  *this = ModeIdentifier(damping_ratio_, learns_);
  follows_contact_ = follows;
  setModes(modes);
}

}  // namespace hammer_loads
