#include "hammer_loads/pipeline/hull_motion_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

// First guesses of a reading's noise, for a usual MEMS unit; the noise is estimated later.
constexpr double kForceNoise = 0.1, kRateNoise = 0.003;  // [m/s2], [rad/s]
constexpr double kSwings =
    2.0;  // ratio to the immediate response to a load: a hull on oil, whose modes are excited by blows
// Prior: kSwings
// Standard deviation of a constant offset of such a unit, which the filter cannot identify.
constexpr double kForceOffset = 0.05, kRateOffset = 0.005;  // [m/s2], [rad/s]
// Prior: kForceOffset, kRateOffset
// A hull has at least some five times the mass of its rocker.
constexpr double kLightest = 0.2;
// Prior: kLightest
constexpr double kLongestPiece = 2e-3;  // [s]: some 20 per period of 25 Hz
// Numerical: kLongestPiece
constexpr double kWorking = 0.05;  // part of the greatest load above which the hammer is at work
// Prior: kForceNoise

constexpr double kStiffest = 4e3;  // [1/s2]: some 10 Hz
constexpr double kDamped = 10.0;   // [1/s]: a twelfth of critical damping at kStiffest
constexpr double kArm = 0.5;       // arm of a hull's rotation: from D to its suspension [m]
// Prior: kRateNoise, kStiffest, kDamped, kArm

/// Returns the settings of a signal. signal_arm: 1 for a force's signal, kArm for turning.
DrivenSignal::Settings signalOf(DrivenSignal::Reads reads, double noise, Eigen::Vector3d compliance,
                                double signal_arm) {
  const Eigen::Vector3d by = 1.0 / signal_arm * Eigen::Vector3d(1.0, 1.0, kArm);
  return {reads, noise, kLightest * compliance, kStiffest * by, kDamped * by};
}

DrivenSignal::Settings forceSignal(const HammerParameters& p) {
  const double by_force = 1.0 / p.rocker_mass, by_moment = by_force / p.rocker_com_distance;
  return signalOf(DrivenSignal::Reads::kItself, kForceNoise, {by_force, by_force, by_moment}, 1.0);
}

DrivenSignal::Settings turningSignal(const HammerParameters& p) {
  const double by_force = 1.0 / (p.rocker_mass * p.rocker_com_distance);
  return signalOf(DrivenSignal::Reads::kIntegral, kRateNoise, {by_force, by_force, 1.0 / p.rocker_inertia_about_pivot},
                  kArm);
}

}  // namespace

HullMobility::HullMobility(const Boom& boom, const Eigen::Vector3d& position)
    : chain_(boom.chain()), mass_(chain_), unit_(position), refresh_angle_(boom.parameters().vibration.refresh_angle) {
  for (const Cylinder& cylinder : boom.cylinders()) joints_.push_back(cylinder.joint());
}

std::optional<HullMobility::Mobility> HullMobility::movedTo(const JointVector& position) noexcept {
  const auto n = static_cast<int>(joints_.size());
  if (n == 0) return std::nullopt;
  if (at_.size() > 0 && (position - at_).cwiseAbs().maxCoeff() <= refresh_angle_) return std::nullopt;
  at_ = position;
  forwardKinematics(chain_, position, pose_);
  const Jacobian tip = tipJacobian(pose_);
  const JointMatrix all = mass_.at(position);
  JointMatrix M(n, n);
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxJoints> of_d(3, n);
  for (int i = 0; i < n; ++i) {
    const int joint = joints_[static_cast<std::size_t>(i)];
    of_d.col(i) << tip(0, joint), tip(2, joint), tip(4, joint);
    for (int k = 0; k < n; ++k) M(i, k) = all(joint, joints_[static_cast<std::size_t>(k)]);
  }
  auto of_unit = of_d;
  of_unit.row(0) += unit_.z() * of_d.row(2), of_unit.row(1) -= unit_.x() * of_d.row(2);
  const Eigen::LLT<JointMatrix> factor(M);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const auto mobility = [&](const auto& of, const auto& by) {
    return Eigen::Matrix3d(of * factor.solve(by.transpose()));
  };
  // No entry of a positive definite matrix exceeds the geometric mean of the two diagonal entries.
  const Eigen::Vector3d rows = mobility(of_unit, of_unit).diagonal().cwiseSqrt();
  const Eigen::Vector3d columns = mobility(of_d, of_d).diagonal().cwiseSqrt();
  const Mobility result{mobility(of_unit, of_d), rows * columns.transpose()};
  if (!result.value.allFinite() || !result.most.allFinite()) return std::nullopt;
  return result;
}

HullMotionFilter::HullMotionFilter(const HullImuSettings& imu, const HammerParameters& hammer)
    : settings_(imu), x_(forceSignal(hammer)), z_(forceSignal(hammer)), turning_(turningSignal(hammer)) {}

void HullMotionFilter::expect(const HullMobility::Mobility& mobility) noexcept {
  mobility_ = mobility;
  int row = 0;
  for (DrivenSignal* signal : {&x_, &z_, &turning_}) {
    signal->expect(mobility.value.row(row).transpose(), mobility.most.row(row).transpose());
    ++row;
  }
}

void HullMotionFilter::forgetMotion() noexcept {
  x_.forgetMotion(), z_.forgetMotion(), turning_.forgetMotion();
  readings_ = 0;
}

void HullMotionFilter::follow(StampNs sample, const WrenchHistory& step, const HullWrench& other_load) noexcept {
  if (step.count == 0) {
    path_.forget();
    forgetMotion();
  } else {
    path_.add(sample, step, path_.known() ? other_load_ : other_load, other_load);
  }
  other_load_ = other_load;
  if (step.length() > 0.0) load_square_.add(path_.at(sample).load.cwiseAbs2(), step.length());
  waiting_.takeUpTo(sample, [this](const StampedImuReading& reading) {
    if (path_.covers(reading.stamp)) update(reading);
  });
}

HullMotionCovariance HullMotionFilter::unread() const noexcept {
  const Eigen::Vector3d square = hammer_loads::square(kSwings) * load_square_.mean();
  return Eigen::Vector4d(x_.yielding(square), z_.yielding(square), 0.0, turning_.yielding(square)).asDiagonal();
}

/// Returns true if the hammer works; at rest readings contain noise alone.
bool HullMotionFilter::works(const Eigen::Vector3d& load) noexcept {
  const double size = load.head<2>().norm();
  if (size > greatest_load_) {
    for (DrivenSignal* signal : {&x_, &z_, &turning_}) signal->outdate(square(greatest_load_ / size));
    greatest_load_ = size;
  }
  return size > kWorking * greatest_load_;
}

/// Calls each(step) for short pieces from the last reading to a stamp. signals: swings of all three signals in a piece.
template <typename Signals, typename Each>
void HullMotionFilter::forEachStep(StampNs to, const Signals& signals, const Each& each) const noexcept {
  const int count = std::max(1, static_cast<int>(std::ceil(seconds(to - last_.stamp) / kLongestPiece)));
  WrenchPath::Instant before = at_last_;
  StampNs from = last_.stamp;
  for (int i = 1; i <= count; ++i) {
    const StampNs next = last_.stamp + (to - last_.stamp) * i / count;
    const WrenchPath::Instant now = path_.at(next);
    const double h = seconds(next - from);
    const Eigen::Vector3d impulse = now.impulse - before.impulse;
    const Eigen::Vector3d lasting = now.lasting - before.lasting - h * before.impulse;
    const auto [x, z, turns] = signals(h, impulse, lasting);
    each(DrivenSignal::Step{h, impulse, {x.velocity, z.velocity, turns.velocity}, {x.way, z.way, turns.way}});
    before = now, from = next;
  }
}

void HullMotionFilter::beginAnew() noexcept {
  for (DrivenSignal* signal : {&x_, &z_, &turning_}) *signal = DrivenSignal(signal->settings());
  if (mobility_) expect(*mobility_);
  forgetMotion();
}

void HullMotionFilter::update(const StampedImuReading& next) noexcept {
  const double step = seconds(next.stamp - last_.stamp);
  if (readings_ > 0 && step > 0.0 && cameTogether(last_.stamp, next.stamp)) return;
  if (readings_ > 0 && !(step > 0.0 && step <= settings_.max_age)) forgetMotion();
  const WrenchPath::Instant now = path_.at(next.stamp);
  if (readings_ > 0) {
    const auto swings = [&](double h, const Eigen::Vector3d& impulse, const Eigen::Vector3d& lasting) {
      return std::array<DrivenSignal::Swing, 3>{x_.swing(h, impulse, lasting), z_.swing(h, impulse, lasting),
                                                turning_.swing(h, impulse, lasting)};
    };
    forEachStep(next.stamp, swings,
                [&](const DrivenSignal::Step& one) { x_.advance(one), z_.advance(one), turning_.advance(one); });
  }
  const bool counts = works(now.load);
  const ImuReading& r = next.reading;
  const WrenchPath::OtherSide other = path_.otherSide(next.stamp);
  const DrivenSignal::UncertainSide by_load{other.probability, other.load}, by_blow{other.probability, other.blow};
  x_.read(r.specific_force.x(), step, now.load, by_load, counts);
  z_.read(r.specific_force.z(), step, now.load, by_load, counts);
  turning_.read(r.rate.y(), step, now.load, by_blow, counts);
  if (!(x_.isFinite() && z_.isFinite() && turning_.isFinite())) beginAnew();
  if (readings_ > 0) interval_ = step;
  last_ = next;
  at_last_ = now;
  readings_ = std::min(readings_ + 1, 2);
}

std::optional<KnownHullMotion> HullMotionFilter::at(StampNs stamp) const noexcept {
  const double step = seconds(stamp - last_.stamp);
  if (readings_ < 2 || !path_.known() || !(step >= 0.0 && step <= settings_.max_age)) return std::nullopt;
  const WrenchPath::Instant now = path_.at(stamp);
  std::array<DrivenSignal::Future, 3> future{DrivenSignal::Future(x_), DrivenSignal::Future(z_),
                                             DrivenSignal::Future(turning_)};
  const auto swings = [&](double h, const Eigen::Vector3d& impulse, const Eigen::Vector3d& lasting) {
    return std::array<DrivenSignal::Swing, 3>{future[0].swing(h, impulse, lasting),
                                              future[1].swing(h, impulse, lasting),
                                              future[2].swing(h, impulse, lasting)};
  };
  const double ahead = step - std::max(0.0, overdue(step, interval_));
  forEachStep(last_.stamp + std::llround(ahead / kSecondsPerNs), swings, [&](const DrivenSignal::Step& one) {
    for (DrivenSignal::Future& signal : future) signal.advance(one);
  });
  const DrivenSignal::Value x = future[0].at(now.load), z = future[1].at(now.load), turns = future[2].at(now.load);
  Eigen::Vector3d rate = last_.reading.rate;
  rate.y() = turns.integral;
  const Eigen::Vector3d& r = settings_.position;
  const Eigen::Vector3d force = Eigen::Vector3d(x.signal, 0.0, z.signal) -
                                Eigen::Vector3d(0.0, turns.signal, 0.0).cross(r) - rate.cross(rate.cross(r));
  KnownHullMotion known;
  known.motion = {{-force.x(), -force.z()}, turns.integral, turns.signal};
  Eigen::Vector4d by_turning(r.z(), -r.x(), 0.0, 1.0),
      by_rate(-2.0 * rate.y() * r.x(), -2.0 * rate.y() * r.z(), 1.0, 0.0);
  HullMotionCovariance& P = known.covariance;
  P = turns.signal_variance * by_turning * by_turning.transpose() +
      (turns.integral_variance + square(kRateOffset)) * by_rate * by_rate.transpose() +
      turns.covariance * (by_turning * by_rate.transpose() + by_rate * by_turning.transpose());
  // A position error r adds turning x r and rate x (rate x r), equally along x and z.
  const double alike =
      square(kForceOffset) + square(settings_.position_std) * (square(turns.signal) + square(square(rate.y())));
  P(0, 0) += x.signal_variance + alike, P(1, 1) += z.signal_variance + alike;
  return known;
}

}  // namespace hammer_loads
