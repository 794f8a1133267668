/// Standard deviations of the published wrench, from the crank estimate's covariance.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/hull_motion_filter.h"

namespace hammer_loads {

class CrankFilter;

/// Uncertainty of a wrench; NaN where the crank's covariance is not known.
struct HullDeviation {
  /// Covariance of force_x [N], force_z [N] and torque_y [N m], in products of these.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d common_covariance{
      Eigen::Matrix3d::Zero()};  ///< the part that is equal in all samples, due to constants

  /// Standard deviations of force_x [N], force_z [N], torque_y [N m].
  HullWrench wrench() const noexcept { return deviationOf(covariance); }
  HullWrench common() const noexcept { return deviationOf(common_covariance); }
  /// Returns coefficients of (force_x, force_z), (force_x, torque_y), (force_z, torque_y) [-]; 0 for a deviation of 0.
  Eigen::Vector3d correlation() const noexcept { return correlationOf(covariance); }
  Eigen::Vector3d commonCorrelation() const noexcept { return correlationOf(common_covariance); }

  static HullWrench deviationOf(const Eigen::Matrix3d& covariance) noexcept {
    return wrenchOf(covariance.diagonal().cwiseMax(0.0).cwiseSqrt());
  }
  static Eigen::Vector3d correlationOf(const Eigen::Matrix3d& covariance) noexcept;

  double angle{};                                                ///< standard deviation of the crank angle [rad]
  double speed{};                                                ///< [rad/s]
  double acceleration{};                                         ///< [rad/s2]
  double common_angle{}, common_speed{}, common_acceleration{};  ///< parts due to constants
};

/// Motion of the links at a crank angle and slightly beside it, for gradients with respect to the angle.
struct LinksForGradient {
  LinksForGradient(const HullModel& model, const LinksAtAngle& at) noexcept;
  LinksAtAngle here, stepped;
};

/// Returns the standard deviations, linearised at the estimate (differences, good to some 1e-5), with the drive's
/// reaction. covariance: of (angle, speed, acceleration). The model's own error is not included. Some 0.3 us.
HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                            const LinksForGradient& links, const HullMotion& hull,
                            const Eigen::Matrix3d& covariance) noexcept;
inline HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                                   const HullMotion& hull, const Eigen::Matrix3d& covariance) noexcept {
  return hullDeviation(model, drive, crank, LinksForGradient(model, linksAt(model, crank.position.angle)), hull,
                       covariance);
}

/// Independent errors of a wrench, one standard deviation each, equal in all samples. Their columns: constants of
/// sensor and hammer (order of ConstantErrors), learned drive inertia, hull whose motion is not measured. Rows: force_x
/// [N], force_z [N], torque_y [N m].
constexpr int kInertiaColumn = ConstantErrors::kSize, kHullColumn = kInertiaColumn + 1,
              kLoadColumns = (kHullColumn + 4) / 4 * 4;
using LoadColumns = ByConstants<3, kLoadColumns>;

/// Returns errors by samples and constants: J P J^T + (J V + dload/dp)(J V + dload/dp)^T (Schmidt's consider filter).
HullDeviation hullDeviation(const WrenchColumns& hammer, const HullModel& model, double drive_inertia,
                            const CrankEstimate& crank, const LinksForGradient& links, const HullMotion& hull,
                            const CrankUncertainty& uncertainty, LoadColumns& columns) noexcept;

/// Adds the hull's motion to the covariance of the load. It is linear, as the load is in all but the rate. Errors of
/// crank and IMU are independent.
void addHullMotion(const HullModel& model, const DriveReaction& drive, const LinkMotion& links, double crank_speed,
                   const HullMotion& hull, const HullMotionCovariance& covariance, HullDeviation& deviation) noexcept;

/// Returns the standard deviation of the momentum with the drive's, for one end of an impulse [N s, N s, N m s].
HullWrench momentumDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                             const LinksForGradient& links, const Eigen::Matrix3d& covariance) noexcept;

/// Independent errors of the momentum, one standard deviation each, in the order of LoadColumns. Rows: x, z [N s].
using MomentumColumns = ByConstants<2, kLoadColumns, double>;

/// Returns the links' momentum errors at a crank angle and speed [rad/s]. of_speed: errors of that speed [rad/s].
MomentumColumns momentumColumns(const WrenchColumns& hammer, const HullModel& model, CrankAngle angle, double speed,
                                const ConstantErrors::Row& of_speed) noexcept;
/// Returns the errors of the links' weight due to errors of the masses [N].
MomentumColumns weightColumns(const WrenchColumns& hammer, const HullModel& model, Gravity gravity) noexcept;

/// Returns three independent errors of the load due to samples and sensor constants, for the links' motion relative to
/// the hull. Empty without a covariance. The boom's filters treat them as noise. Errors of the hammer's constants are
/// equal in all samples, are no noise, and are not included.
WrenchSpread wrenchSpread(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                          const LinksForGradient& links, const Eigen::Matrix3d& own,
                          const LoadColumns& columns) noexcept;

/// Returns the errors of constants as three independent ones, one per column (rows as LoadColumns): of all constants,
/// or of the hammer's alone.
Eigen::Matrix3d constantErrors(const LoadColumns& columns) noexcept;
Eigen::Matrix3d hammerErrors(const LoadColumns& columns) noexcept;

/// Returns the standard deviation of the crank's angle from the blow [rad]. It contains that of the angle, the zero
/// error that the readings show, and the later blow of an elastic rod. angle_std: of the angle [rad]; NaN: not known.
double deviationFromBlow(const CrankFilter& filter, double angle_std) noexcept;

/// Returns true if the crank is too close to the blow. The wrench jumps there (MO-100: Fx by nearly all of its peak);
/// which side applies is unknown and WrenchStamped has no deviation for it. The jump is below 1 % for a slow crank and
/// zero on the mirrored branch. distance: from the blow within which the crank is too close [rad]; NaN: not known.
bool isBesideBlow(const CrankEstimate& crank, double distance) noexcept;
/// Returns true if the crank is too close to the blow for its side to be known. The limit is three standard deviations
/// of angle and zero, or two of deviationFromBlow(). angle_std: standard deviation of the angle [rad], 0 where the
/// encoder's count shows the side as far as the zero is known. rod: result of the elastic rod's filter; empty: the rod
/// is rigid. Before the zero is known, the mirrored branch counts as close, since a wrong zero imitates a blow without
/// a tool.
bool isBesideBlow(const CrankFilter& filter, const CrankEstimate& crank, double angle_std,
                  std::optional<bool> rod) noexcept;

}  // namespace hammer_loads
