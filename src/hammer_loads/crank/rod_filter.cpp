#include "hammer_loads/crank/rod_filter.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/covariance_root.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kFirstRestitution = 0.16, kRestitutionDeviation = 0.1;
constexpr double kPlaceDeviation = 5e-3;  // [rad]: a millimetre
// Prior: kFirstRestitution, kRestitutionDeviation, kPlaceDeviation
constexpr double kOtherPlace = 2e-2;  // [rad] after an unexplained blow: a retainer is 5 mm away
// Prior: kOtherPlace
constexpr double kWalks[] = {0.005, 0.01, 5e-6, 5e-5, 0.02, 4e-3};  // identified rows, from blow to blow
// Prior: kWalks
constexpr double kLeastStiffness = 5e7, kMostStiffness = 1e11;  // [N/m]
constexpr double kLeastDamping = 0.02, kMostDamping = 20.0;
// Prior: kLeastStiffness, kMostStiffness, kLeastDamping, kMostDamping
constexpr double kLongest = 5e-4, kLongestLater = 1e-3;  // [s]: longest part; near the blow the lever changes fast
// Numerical: kLongest, kLongestLater
constexpr double kNear = 0.25;  // [rad]
// Numerical: kNear
constexpr double kAngleStd = 1e-4, kSpeedStd = 0.02, kInertiaStd = 0.01;  // added to a rigid rod's estimate
// Prior: kAngleStd, kSpeedStd, kInertiaStd
constexpr double kSettledX = 3e-5, kSettledSpeed = 0.02;  // [rad], [rad/s]
// Prior: kSettledX, kSettledSpeed
constexpr double kUnmodelled = 1.0;  // [rad/s/sqrt(s)] of the rocker's speed
// Prior: kUnmodelled
constexpr double kNotCoulomb = 0.1;    // part of the friction radius
constexpr double kUnidentified = 0.3;  // part of its standard deviation that is not identified
constexpr double kHeld = 0.02;         // T [s]
// Prior: kNotCoulomb, kUnidentified, kHeld
constexpr int kEnough = 8;

/// Sets the rows of an error that a step or a bound changes. of: displaced motion; from: undisplaced motion.
void follow(const RodMotion& of, const RodMotion& from, Eigen::Ref<RodFilter::Belief::Vector> error) noexcept {
  error[RodFilter::kAngle] = of.state.angle.offset - from.state.angle.offset;
  error[RodFilter::kSpeed] = of.state.speed - from.state.speed;
  error[RodFilter::kDisplacement] = of.state.displacement - from.state.displacement;
  error[RodFilter::kDisplacementRate] = of.state.displacement_rate - from.state.displacement_rate;
  error[RodFilter::kTorque] = of.torque - from.torque;
  error[RodFilter::kPlay] = of.rod.play - from.rod.play;
  error[RodFilter::kFriction] = of.rod.friction_radius - from.rod.friction_radius;
}

}  // namespace

RodFilter::RodFilter(const Mechanism& mechanism, Pins pins) noexcept : bodies_(mechanism) {
  const HammerParameters& p = mechanism.parameters();
  const RodPrior prior = priorOf(p.rod, p.rod_std);
  const bool worn = pins == Pins::kPlay;
  const double play = worn ? prior.play : 0.0, friction = worn ? 0.0 : prior.friction_radius;
  learned_.rod = prior.rod;
  if (!worn || !(prior.rod.play > 0.0)) learned_.rod.play = play;
  learned_.restitution = kFirstRestitution;
  unknown_friction_ = (worn ? 1.0 : kUnidentified) * prior.friction_radius;
  Eigen::Matrix<double, kLearned, 1> deviations;
  deviations << prior.log_stiffness, prior.log_damping, play, friction, kRestitutionDeviation, kPlaceDeviation;
  learned_covariance_ = deviations.cwiseAbs2().asDiagonal();
  first_ = learned_;
  first_covariance_ = learned_covariance_;
}

void RodFilter::begin(const CrankFilter& crank, Gravity gravity) noexcept {
  const ShaftState& s = crank.state();
  gravity_ = gravity;
  motion_ = learned_;
  motion_.state = {s.position.angle, s.speed, 0.0, 0.0};
  motion_.torque = s.torque;
  motion_.inertia = s.drive_inertia;
  since_blow_ = ratio_sum_ = fit_ = rod_force_ = 0.0;
  running_ = true;
  samples_ = 0;
  constexpr Eigen::Index kOf[] = {kAngle, kSpeed, kTorque, kInertia};
  const double deviations[] = {kAngleStd, kSpeedStd, 0.0, kInertiaStd};
  belief_.covariance.setZero();
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index k = 0; k < 4; ++k) belief_.covariance(kOf[i], kOf[k]) = crank.growth() * crank.covariance()(i, k);
    belief_.covariance(kOf[i], kOf[i]) += square(deviations[i]);
  }
  for (Eigen::Index i = 0; i < kLearned; ++i)
    if (learned_covariance_(i, i) > 0.0) learned_covariance_(i, i) += square(kWalks[i]);
  belief_.covariance.bottomRightCorner<kLearned, kLearned>() = learned_covariance_;
  const Belief::Matrix root = covarianceRoot(belief_.covariance);
  bodies_.settle(motion_.rod, drive(motion_), motion_.state);
  Belief::Matrix settled = root;
  for (Eigen::Index i = 0; i < kSize; ++i) {
    RodMotion other = displaced(root.col(i));
    bodies_.settle(other.rod, drive(other), other.state);
    follow(other, motion_, settled.col(i));
  }
  belief_.covariance = covarianceOf(settled);
  belief_.addNoise(kDisplacement, kDisplacement, square(kSettledX));
  belief_.addNoise(kDisplacementRate, kDisplacementRate, square(kSettledSpeed));
  root_ = covarianceRoot(belief_.covariance);
}

RodMotion RodFilter::displaced(const Belief::Vector& by) const noexcept {
  RodMotion m = motion_;
  m.state.angle.offset += by[kAngle];
  m.state.speed += by[kSpeed];
  m.state.displacement += by[kDisplacement];
  m.state.displacement_rate += by[kDisplacementRate];
  m.torque += by[kTorque];
  m.inertia *= hammer_loads::growth(by[kInertia]);
  m.rod.stiffness *= hammer_loads::growth(by[kStiffness]);
  m.rod.damping_ratio *= hammer_loads::growth(by[kDamping]);
  m.rod.play = std::max(0.0, m.rod.play + by[kPlay]);
  m.rod.friction_radius = std::max(0.0, m.rod.friction_radius + by[kFriction]);
  m.restitution += by[kRestitution];
  m.place += by[kPlace];
  return m;
}

/// Advances a motion and returns its blow. first: links of the step's first part, shared by machines at the same angle.
std::optional<TwoBodies::Blow> RodFilter::advance(double dt, bool strikes, RodMotion& m,
                                                  TwoBodies::LinksMemo& first) const noexcept {
  const TwoBodyDrive by = drive(m);
  const double longest = std::abs(m.state.angle.offset) < kNear ? kLongest : kLongestLater;
  const int parts = partsOf(dt, longest);
  const double from = m.state.angle.offset, part = dt / parts;
  std::optional<TwoBodies::Blow> blow;
  TwoBodies::LinksMemo later;
  for (int i = 0; i < parts; ++i) {
    TwoBodies::LinksMemo& memo = i == 0 ? first : later;
    if (!strikes) {
      bodies_.move(m.rod, by, part, m.state, memo);
    } else if (const auto now = bodies_.moveToTool(m.rod, by, {m.place, m.restitution}, part, m.state, memo)) {
      blow = now;
      blow->time += i * part;
    }
  }
  m.torque -= supply_.stiffness * supply_.lead(m.state.angle.offset - from, dt);
  return blow;
}

RodMotion RodFilter::between(double time) const noexcept {
  RodMotion there = before_;
  TwoBodies::LinksMemo memo;
  if (time > 0.0) advance(time, true, there, memo);
  return there;
}

void RodFilter::move(double dt, const CrankWalks& walks, Gravity gravity) noexcept {
  gravity_ = gravity;
  supply_ = walks.supply;
  before_ = motion_;
  RodMotion there = motion_;
  TwoBodies::LinksMemo memo;
  blow_ = advance(dt, true, there, memo);
  const bool struck = there.state.angle.side == Side::kAfterBlow;
  const Eigen::Index count = struck && !hasStruck() ? kSize : kRestitution;  // number of columns that a step moves
  const TwoBodyState& last = blow_ ? blow_->before : motion_.state;
  if (!hasStruck()) rocker_before_ = bodies_.links(last.angle).rocker.u * last.speed + last.displacement_rate;
  Belief::Matrix moved = root_;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!(root_(i, i) > 0.0)) continue;
    RodMotion other = displaced(root_.col(i));
    advance(dt, struck, other, memo);
    if (struck && other.state.angle.side == Side::kBeforeBlow)
      bodies_.strikeEarly(drive(other), {other.place, other.restitution}, other.state);
    follow(other, there, moved.col(i));
  }
  if (hasStruck()) since_blow_ += dt;
  motion_ = there;
  belief_.covariance = covarianceOf(moved);
  const double torque = square(walks.torque) * dt, b = 1.0 / motion_.inertia;
  belief_.addNoise(kTorque, kTorque, torque);
  belief_.addNoise(kSpeed, kSpeed, square(walks.speed) * dt + torque * square(b * dt) / 3.0);
  belief_.addNoise(kSpeed, kTorque, 0.5 * torque * b * dt);
  belief_.addNoise(kDisplacementRate, kDisplacementRate, square(kUnmodelled) * dt);
  if (hasStruck()) addFriction(dt);
}

/// Adds the noise of friction at the end of a step of dt [s].
void RodFilter::addFriction(double dt) noexcept {
  const double inertia = bodies_.mechanism().parameters().rocker_inertia_about_pivot;
  const LinkMotion links = bodies_.links(motion_.state.angle);
  const TwoBodyAccelerations a = bodies_.accelerations(motion_.rod, drive(motion_), motion_.state, links);
  rod_force_ = std::max(std::abs(a.tension), rod_force_ * std::exp(-dt / kHeld));
  const double deviation = std::sqrt(belief_.covariance(kFriction, kFriction));
  const double radius = kNotCoulomb * std::hypot(motion_.rod.friction_radius, deviation, unknown_friction_);
  const double impulse = 2.0 * kHeld * square(radius * rod_force_) * dt;  // square of an impulse [(N m s)^2]
  belief_.addNoise(kDisplacementRate, kDisplacementRate, impulse / square(inertia));
  belief_.addNoise(kSpeed, kSpeed, impulse / square(motion_.inertia));
}

bool RodFilter::update(const WeighedSample& sample) noexcept {
  const double innovation = CrankAngle::wrapToPi(sample.angle - motion_.state.angle.offset);
  const double variance = sample.angleVariance(motion_.state.speed);
  const double total = belief_.covariance(kAngle, kAngle) + variance;
  ratio_sum_ += square(innovation) / total;
  fit_ -= 0.5 * (square(innovation) / total + std::log(total));
  ++samples_;
  if (!std::isfinite(ratio_sum_) || exceeds(innovation, growth() * total, gate::kImpossible)) return false;
  if (samples_ >= kEnough && growth() > mismatch::kContradicts) return false;
  motion_ = displaced(belief_.correct(kAngle, variance, Belief::ConstantRow()) * innovation);
  motion_.restitution = std::clamp(motion_.restitution, 0.0, 1.0);
  motion_.rod.stiffness = std::clamp(motion_.rod.stiffness, kLeastStiffness, kMostStiffness);
  motion_.rod.damping_ratio = std::clamp(motion_.rod.damping_ratio, kLeastDamping, kMostDamping);
  root_ = covarianceRoot(belief_.covariance);
  return belief_.isSound();
}

double RodFilter::growth() const noexcept { return samples_ < kEnough ? 1.0 : std::max(1.0, ratio_sum_ / samples_); }

double RodFilter::frictionDeviation() const noexcept {
  return std::hypot(kUnidentified * motion_.rod.friction_radius, deviation(kFriction), unknown_friction_);
}

RodFilter::Belief::Matrix RodFilter::errors() const noexcept { return std::sqrt(growth()) * root_; }

void RodFilter::learn() noexcept {
  running_ = false;
  proven_ = samples_ >= kEnough && hasStruck() && std::isfinite(ratio_sum_) && belief_.isSound() &&
            growth() < mismatch::kSeen;
  learned_ = proven_ ? motion_ : first_;
  learned_covariance_ =
      proven_ ? Learned(belief_.covariance.bottomRightCorner<kLearned, kLearned>()) : first_covariance_;
  if (!proven_ && hasStruck()) learned_covariance_(kLearned - 1, kLearned - 1) = square(kOtherPlace);
}

}  // namespace hammer_loads
