#include "hammer_loads/boom/mode_identifier.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/functions.h"
#include "hammer_loads/util/known_count.h"

namespace hammer_loads {
namespace {

constexpr double kCommonDeviation = 2.0 * kFrequencyDeviation;  // of log stiffness, common to all cylinders
constexpr double kOilWalk = 0.004;     // per second, of log stiffness: oil that warms up, a pose that changes
constexpr double kDampingWalk = 0.01;  // per second, of log damping
constexpr double kRubbingWalk = 0.02;  // per second, of the friction over its deviation
// Prior: kOilWalk, kDampingWalk, kRubbingWalk
constexpr double kUnknownRate = 0.05;  // joint velocity where nothing is known [rad/s]
// Prior: kUnknownRate
constexpr double kContactWalk = 1.3e5;    // random walk of the rock's force [N/sqrt(s)]
constexpr double kContactWalkSeen = 3e5;  // with an IMU, which shows each landing: a landing is then no noise
// Prior: kContactWalkSeen
constexpr double kUnknownContact = 1e4;  // deviation of the rock's force at the start [N]
// Prior: kContactWalk, kUnknownContact
constexpr double kLeastDamping = 2e-3, kMostDamping = 0.7;
// Prior: kLeastDamping, kMostDamping

constexpr int kMostStates = 64;  // room for those of a ModeIdentifier

/// New values of two neighbouring states: weighted sums over two states or more, which include both.
struct TwoOf {
  static constexpr int kMost = 24;
  int count{};
  std::array<int, kMost> state;
  std::array<double, kMost> by_one, by_other;

  void add(int of, double one, double other) noexcept {
    const auto i = static_cast<std::size_t>(count++);
    state[i] = of, by_one[i] = one, by_other[i] = other;
  }
};

/// P <- F P F^T, where F makes the states `first` and the one after it. P stays symmetric to the last bit.
void replaceTwo(Eigen::Ref<Eigen::MatrixXd> P, int first, const TwoOf& of) noexcept {
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostStates, 1>;
  // Products of P and a row of F.
  Column one = of.by_one[0] * P.col(of.state[0]) + of.by_one[1] * P.col(of.state[1]);
  Column other = of.by_other[0] * P.col(of.state[0]) + of.by_other[1] * P.col(of.state[1]);
  std::size_t k = 2;
  for (const auto count = static_cast<std::size_t>(of.count); k + 1 < count; k += 2) {
    const auto a = P.col(of.state[k]), b = P.col(of.state[k + 1]);
    one += of.by_one[k] * a + of.by_one[k + 1] * b;
    other += of.by_other[k] * a + of.by_other[k + 1] * b;
  }
  if (k < static_cast<std::size_t>(of.count)) {
    one += of.by_one[k] * P.col(of.state[k]), other += of.by_other[k] * P.col(of.state[k]);
  }
  const auto times = [&](const Column& column, const std::array<double, TwoOf::kMost>& by) {
    double sum = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(of.count); ++i) sum += by[i] * column[of.state[i]];
    return sum;
  };
  const double both = 0.5 * (times(one, of.by_other) + times(other, of.by_one));
  one[first] = times(one, of.by_one), other[first + 1] = times(other, of.by_other);
  one[first + 1] = other[first] = both;
  P.col(first) = one, P.col(first + 1) = other;
  P.row(first) = one.transpose(), P.row(first + 1) = other.transpose();
}

}  // namespace

ModeIdentifier::ModeIdentifier(double damping_ratio, bool learns, const LogOil& own_std)
    : damping_ratio_(damping_ratio),
      least_damping_(std::log(kLeastDamping / damping_ratio)),
      most_damping_(std::log(kMostDamping / damping_ratio)),
      learns_(learns),
      own_std_(own_std) {
  if (learns) setFirstGuesses();
  covariance_(kContact, kContact) = square(kUnknownContact);
  ratio_.fill(1.0);
  damping_.fill(damping_ratio);
  slot_.fill(-1);
  rubbing_at_.fill(-1);
}

void ModeIdentifier::setFirstGuesses() noexcept {
  for (int k = 0; k < kMaxJoints; ++k) {
    for (int l = 0; l < kMaxJoints; ++l)
      covariance_(at(k, kOil), at(l, kOil)) = square(kCommonDeviation) + (k == l ? square(own_std_[k]) : 0.0);
    covariance_(at(k, kDamping), at(k, kDamping)) = square(kDampingDeviation);
  }
}

void ModeIdentifier::setModes(const BoomModes& given, const LogOil& stiffer) noexcept {
  const bool carries = moving_known_ && count_ == given.count;
  JointMatrix T(given.count, given.count);  // new modal displacements of the old ones, through the joints
  if (carries) {
    for (int k = 0; k < count_; ++k) {
      JointVector unit = JointVector::Zero(count_);
      unit[k] = 1.0;
      T.col(k) = modalOf(given, jointsOf(modes_, unit));
    }
  }
  if (count_ != given.count) history_ = ModeHistory();  // unused modes are zero
  modes_ = given;
  count_ = given.count;
  history_.clear();
  if (!carries) {
    forgetMotion();
  } else {
    transform(T);
  }
  for (int i = 0; i < count_; ++i) state_[at(i, kOil)] -= stiffer[i];
  useOil();
}

/// Transforms the displacements and velocities of the modes by T. Frequencies, dampings and offsets are unchanged.
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
  for (int i = begin(); i < end(); ++i) apply(&covariance_(0, i), 1);
  for (int i = begin(); i < end(); ++i) apply(covariance_.data() + i, kMaxStates);
  const auto turn = [&](ModeVector& modal) { modal.head(count_) = (T * modal.head(count_)).eval(); };
  turn(force_), turn(force_rate_);
  if (struck_) turn(*struck_);
  if (behind_hose_) turn(behind_hose_->torque), turn(behind_hose_->rate);
  for (std::size_t i = 0; i < held_.size(); ++i)
    for (ModeVector* each : {&held_[i].from, &held_[i].to, &held_[i].mean, &held_[i].jump}) turn(*each);
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
  held_.clear();
  behind_hose_.reset();
  waiting_ = 0.0;
  struck_.reset();
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
  if (isExplained()) explained_for_ += step;
  if (learns_ && !explains_ && !seeks_ && explained_for_ < kProven) seeks_ = explains_ = true, innovation_ratio_ = 1.0;
  const double share = std::min(1.0, step / look_back::kTenTurns);
  for (int k = 0; k < count_; ++k) {
    double& power = force_power_[static_cast<std::size_t>(k)];
    power += share * (square(modal.mean[k]) - power);
  }
  held_.push(step, modal);
  applyForces(step);
  for (double& age : age_) age += step;
  imu_age_ += step;
  free_for_ = follows_contact_ && !bears_ ? free_for_ + step : 0.0;
  if (follows_contact_) walkContact(step);
  advanceDelays(step);
  for (int i = begin(); i < end(); ++i) covariance_(i, i) = std::max(covariance_(i, i), 0.0);
  if (!finite()) startAnew();
}

void ModeIdentifier::advanceModes(const HeldForces::Piece& piece) noexcept {
  const double step = piece.duration;
  history_.begin(step);
  std::array<ModeStep, kMaxJoints> steps;
  const States now = statesNow();
  States then;
  const LogOil way_next = wayOfSeals(step);
  const ModeVector rubbed = forceOfSeals(0.5 * (way_ + way_next));
  for (int k = 0; k < count_; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const ModeStep& its = steps[mode] = stepOf(modeAt(k), step);
    const double external = rockOn(k) * state_[kContact] + rubbed[k];
    const ModeState& before = now[mode];
    ModeState& next = then[mode] = advanced(its, before, pathOf({piece.from[k], piece.to[k], piece.mean[k]}, step));
    next.x += its.r.step * external, next.v += its.r.impulse * external;
    state_[at(k, kX)] = next.x, state_[at(k, kV)] = next.v;
    history_.set(k, before, next, piece.from[k], piece.to[k]);
  }
  followHose(step, now, then);
  force_ = piece.to;
  force_rate_ = (piece.to - piece.from) / step;
  advanceCovariance(step, steps, now, then, way_next);
  way_ = way_next;
  for (int k = 0; k < count_; ++k) walk(k, step);
}

/// P <- F P F^T. Stiffness and damping act as forces that are linear over the step: their derivatives are off by 3 % at
/// 9 Hz and a step of 10 ms, the states themselves are exact.
void ModeIdentifier::advanceCovariance(double step, const std::array<ModeStep, kMaxJoints>& its, const States& now,
                                       const States& next, const LogOil& way_next) noexcept {
  static_assert(kMaxStates <= kMostStates);
  const LogOil torque_now = oilTorques(now), torque_next = oilTorques(next);
  const LogOil rubbed_now = sealTorques(way_), rubbed_next = sealTorques(way_next);
  const double per_time = 1.0 / step;
  const int first = begin();
  for (int k = 0; k < count_; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const ModeStep& own = its[mode];
    const ModeResponse& r = own.r;
    const auto by = [&](double from, double to) {  // of a force
      const double slope = (to - from) * per_time;
      return ModeState{from * r.step + slope * r.ramp, from * r.impulse + slope * r.step};
    };
    const Mode here = modeAt(k);
    const double damped = 2.0 * here.zeta * here.omega, damped_now = damped * now[mode].v,
                 damped_next = damped * next[mode].v;
    const int x = at(k, kX) - first;
    TwoOf of;
    of.add(x + kX, own.x_by_x, own.v_by_x);
    of.add(x + kV, own.x_by_v, own.v_by_v);
    for (int i = 0; i < count_ && learns_; ++i) {
      const double shape = modes_.shape(i, k), share = 0.5 * modes_.oil_share(i, k);
      const ModeState of_oil =
          by(-shape * torque_now[i] - share * damped_now, -shape * torque_next[i] - share * damped_next);
      of.add(at(i, kOil) - first, of_oil.x, of_oil.v);
    }
    const ModeState of_damping = by(-damped_now, -damped_next);
    of.add(x + kDamping, of_damping.x, of_damping.v);
    for (int i = 0; i < count_; ++i) {
      const int rubs = rubbing_at_[static_cast<std::size_t>(i)];
      if (rubs < 0) continue;
      const ModeState of_seals = by(-modes_.shape(i, k) * rubbed_now[i], -modes_.shape(i, k) * rubbed_next[i]);
      of.add(rubs - first, of_seals.x, of_seals.v);
    }
    of.add(kContact - first, r.step * rockOn(k), r.impulse * rockOn(k));
    if (isDelayFollowed(Clock::kImu))
      of.add(delayAt(Clock::kImu) - first, -force_rate_[k] * r.step, -force_rate_[k] * r.impulse);
    replaceTwo(block(), x, of);
  }
}

/// Correction for a blow that acts a little later. force: change of the forces by the blow.
void ModeIdentifier::addBlowToDelay(const ModeVector& force) noexcept {
  for (int k = 0; k < count_ && isDelayFollowed(Clock::kImu); ++k) {
    const Mode m = modeAt(k);
    const double jump = (*struck_)[k];
    const int x = at(k, kX) - begin();
    TwoOf of;
    of.add(x + kX, 1.0, 0.0);
    of.add(x + kV, 0.0, 1.0);
    of.add(delayAt(Clock::kImu) - begin(), -jump, 2.0 * m.zeta * m.omega * jump - force[k]);
    replaceTwo(block(), x, of);
  }
  struck_.reset();
}

/// P <- P + Q: errors of the forces and changes of the oil's temperature; more where readings contradict the identified
/// values.
void ModeIdentifier::walk(int mode, double step) noexcept {
  const int x = at(mode, kX);
  const double v_walk = square(kForcePart) * force_power_[static_cast<std::size_t>(mode)] * 2.0 * kForceTime * step;
  covariance_(x + kV, x + kV) += v_walk;
  covariance_(x + kX, x + kX) += v_walk * step * step / 3.0;
  if (!learns_) return;
  const auto wander = [&](int i, double per_second, double most) {
    if (covariance_(i, i) < most * most) covariance_(i, i) += misfit() * square(per_second) * step;
  };
  wander(x + kOil, kOilWalk, kCommonDeviation);
  wander(x + kDamping, kDampingWalk, kDampingDeviation);
  const int rubs = rubbing_at_[static_cast<std::size_t>(mode)];
  if (rubs >= 0) wander(rubs, kRubbingWalk, 1.0);
}

/// The random walk of the rock's force within the step also changes the modes' velocities.
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

/// Returns false if a state or variance is not finite; it reaches the diagonal with the next step.
bool ModeIdentifier::finite() const noexcept {
  double sum = 0.0;
  for (int i = begin(); i < end(); ++i) sum += 0.0 * (state_[i] + covariance_(i, i));
  return sum == 0.0;
}

void ModeIdentifier::startAnew() noexcept {
  const BoomModes modes = modes_;
  const bool follows = follows_contact_;
  *this = ModeIdentifier(damping_ratio_, learns_, own_std_);
  follows_contact_ = follows;
  setModes(modes);
}

}  // namespace hammer_loads
