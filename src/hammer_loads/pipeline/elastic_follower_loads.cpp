// Loads of an elastic rod with their covariance.
#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/pipeline/elastic_follower.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

/// Returns the rocker's acceleration relative to that of a rigid rod at the crank's acceleration [rad/s2].
double displacementAcceleration(const TwoBodyState& s, const TwoBodyAccelerations& a,
                                const LinkMotion& links) noexcept {
  return a.rocker - links.rocker.u * a.crank - links.rocker.du * s.speed * s.speed;
}

}  // namespace

ElasticFollower::Loads ElasticFollower::loads(const RodMotion& m, const LinkMotion& links,
                                              const DriveReaction& drive) const noexcept {
  const TwoBodies& bodies = filter().bodies();
  const TwoBodyDrive by = filter().drive(m);
  const TwoBodyAccelerations a = bodies.accelerations(m.rod, by, m.state, links);
  const HullWrench w = hullWrenchOf(model_->mechanism(), bodies, m.state, a, links, by.gravity);
  Loads loads;
  loads << w.force_x, w.force_z, w.torque_y + drive.torque(a.crank, 0.0), a.crank,
      displacementAcceleration(m.state, a, links);
  return loads;
}

ElasticFollower::Loads ElasticFollower::rigidLoads(const RodMotion& m, const LinkMotion& links,
                                                   const DriveReaction& drive) const noexcept {
  const TwoBodyDrive by = filter().drive(m);
  const double crank = filter().bodies().rigidAcceleration(by, m.state, links);
  const HullWrench w = hullWrenchLinkage(model_->mechanism(), links, {m.state.angle, m.state.speed, crank}, by.gravity);
  Loads loads;
  loads << w.force_x, w.force_z, w.torque_y + drive.torque(crank, 0.0), crank, 0.0;
  return loads;
}

/// Returns the covariance of the loads with pins that may touch within an error, by three-point Gauss-Hermite
/// quadrature. The links move in proportion to an error of the angle.
ElasticFollower::LoadCovariance ElasticFollower::covariance(const DriveReaction& drive, const LinkMotion& links,
                                                            const Loads& here) const noexcept {
  const RodMotion& now = filter().motion();
  const RodFilter::Belief::Matrix errors = filter().errors();
  LoadCovariance sum = LoadCovariance::Zero();
  const double turned = errors.row(RodFilter::kAngle).norm();
  if (!(turned > 0.0)) return sum;
  const CrankAngle relative{now.state.angle.offset + turned, now.state.angle.side};
  const Loads by_angle = (loads(now, filter().bodies().links(relative), drive) - here) / turned;
  const auto add = [&](const RodFilter::Belief::Vector& error, double weight) {
    const Loads off = loads(filter().displaced(error), links, drive) - here + error[RodFilter::kAngle] * by_angle;
    sum += weight * off * off.transpose();
  };
  if (late_ > 0.0 && filter().hasStruck()) {  // vibration read at a wrong time
    RodMotion later = now;
    filter().bodies().move(later.rod, filter().drive(later), late_, later.state);
    const LinkMotion there = filter().bodies().links(later.state.angle);
    const Loads off =
        loads(later, there, drive) - rigidLoads(later, there, drive) - (here - rigidLoads(now, links, drive));
    sum += off * off.transpose();
  }
  const bool worn = now.rod.play > 0.0;
  const double away = std::sqrt(3.0);
  for (Eigen::Index i = 0; i < RodFilter::kRestitution; ++i) {
    if (!(errors(i, i) > 0.0)) continue;
    if (worn)
      add(-away * errors.col(i), 1.0 / 6.0), add(away * errors.col(i), 1.0 / 6.0);
    else
      add(errors.col(i), 1.0);
  }
  return sum;
}

/// Applies a Kalman correction with x'' = 0 +- the expected magnitude of a vibration.
ElasticFollower::RodLoads ElasticFollower::rodLoads(const DriveReaction& drive, double ring) noexcept {
  const RodMotion& now = filter().motion();
  const LinkMotion links = filter().bodies().links(now.state.angle);
  Loads mean = loads(now, links, drive);
  const LoadCovariance errors = covariance(drive, links, mean);
  if (!filter().hasStruck()) squares_ = {};
  vibration_ = mean[kDisplacementAcceleration];
  squares_.add(square(vibration_));
  gain_.setZero();
  if (filter().hasStruck()) {
    const double expected = std::max({square(ring), squares_.mean(), std::numeric_limits<double>::min()});
    gain_ = errors.col(kDisplacementAcceleration) /
            (errors(kDisplacementAcceleration, kDisplacementAcceleration) + expected);
  }
  const Eigen::Matrix3d covariance =
      errors.topLeftCorner<3, 3>() - gain_.head<3>() * errors.col(kDisplacementAcceleration).head<3>().transpose();
  weightVibration(now, mean);
  mean -= rigidLoads(now, links, drive);
  return {wrenchOf(mean.head<3>()), covariance, mean[kCrank]};
}

void ElasticFollower::weightVibration(const RodMotion& m, Loads& loads) const noexcept {
  if (m.state.angle.side == Side::kAfterBlow) loads -= (gain_ * loads[kDisplacementAcceleration]).eval();
}

ElasticFollower::Instant ElasticFollower::instantOf(const RodMotion& there, bool weighed, const DriveReaction& drive,
                                                    const HullMotion& hull) const noexcept {
  const LinkMotion links = filter().bodies().links(there.state.angle);
  const Loads rigid = rigidLoads(there, links, drive);
  Loads relative = loads(there, links, drive);
  if (weighed) weightVibration(there, relative);
  relative -= rigid;
  Instant instant{{{blow_, there.state.angle}, there.state.speed, rigid[kCrank]}, {}, there.state, links};
  instant.wrench = hullWrench(*model_, drive, links, motionOf(instant.crank), hull) + wrenchOf(relative.head<3>());
  instant.crank.acceleration += relative[kCrank];
  return instant;
}

PinReactions ElasticFollower::pins(const HullMotion& hull, const NearBlow& near) const noexcept {
  const RodMotion& m = filter().motion();
  const TwoBodies& bodies = filter().bodies();
  const LinkMotion rigid = bodies.links(m.state.angle), links = withRocker(rigid, m.state.displacement);
  TwoBodyAccelerations a = bodies.accelerations(m.rod, filter().drive(m), m.state, rigid);
  const double relative = displacementAcceleration(m.state, a, rigid);
  a.crank -= gain_[kCrank] * relative;
  a.rocker -= (rigid.rocker.u * gain_[kCrank] + gain_[kDisplacementAcceleration]) * relative;
  PinReactions pins =
      pinForcesOf(model_->mechanism(), links, bodies.linkAccelerations(m.state, a, links), hull.gravity, near);
  if (hull.turns()) addTurningLinkage(model_->mechanism(), rigid, m.state.speed, hull, near, pins);
  return pins;
}

}  // namespace hammer_loads
