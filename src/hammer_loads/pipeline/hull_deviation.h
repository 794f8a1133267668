/// How far the published wrench may be off, by the crank estimate's covariance.
#pragma once

#include <Eigen/Core>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/pipeline/hull_motion_filter.h"

namespace hammer_loads {

/// Standard deviations; NaN where the estimator has no covariance.
struct HullDeviation {
  HullWrench wrench;      ///< of force_x [N], force_z [N], torque_y [N m]
  double angle{};         ///< of the crank [rad]
  double speed{};         ///< [rad/s]
  double acceleration{};  ///< [rad/s2]
};

/// How the links move at a crank angle and a little beside it: what gradients by the angle need.
struct LinksBeside {
  LinksBeside(const HullModel& model, const LinksAtAngle& at) noexcept;
  LinksAtAngle here, beside;
};

/// covariance of (angle, speed, acceleration), linearised at the estimate (differences, good to some 1e-5), the drive's
/// reaction included. What the model leaves out is not in it. Some 0.3 us.
HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                            const LinksBeside& links, const HullMotion& hull,
                            const Eigen::Matrix3d& covariance) noexcept;
inline HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                                   const HullMotion& hull, const Eigen::Matrix3d& covariance) noexcept {
  return hullDeviation(model, drive, crank, LinksBeside(model, linksAt(model, crank.position.angle)), hull, covariance);
}

/// What the hull's own motion adds to the variances of the load at the links' place, squares of [N, N, N m]: linear, as
/// the load is in all but the rate.
HullWrench hullMotionVariance(const HullModel& model, const DriveReaction& drive, const LinkMotion& links,
                              double crank_speed, const HullMotion& hull,
                              const HullMotionCovariance& covariance) noexcept;

/// Standard deviation of the momentum, the drive's included: of an impulse's one end [N s, N s, N m s].
HullWrench momentumDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                             const LinksBeside& links, const Eigen::Matrix3d& covariance) noexcept;

/// The covariance as three errors of the load that are independent of each other, from motion of the links relative to
/// the hull; none where there is no covariance.
WrenchSpread wrenchSpread(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                          const LinksBeside& links, const Eigen::Matrix3d& covariance) noexcept;

}  // namespace hammer_loads
