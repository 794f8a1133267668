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
      Eigen::Matrix3d::Zero()};  ///< the part that is the same in all samples: of constants

  /// Standard deviations of force_x [N], force_z [N], torque_y [N m].
  HullWrench wrench() const noexcept { return deviationOf(covariance); }
  HullWrench common() const noexcept { return deviationOf(common_covariance); }
  /// Coefficients of (force_x, force_z), (force_x, torque_y), (force_z, torque_y) [-]; 0 beside a deviation of 0.
  Eigen::Vector3d correlation() const noexcept { return correlationOf(covariance); }
  Eigen::Vector3d commonCorrelation() const noexcept { return correlationOf(common_covariance); }

  static HullWrench deviationOf(const Eigen::Matrix3d& covariance) noexcept {
    return wrenchOf(covariance.diagonal().cwiseMax(0.0).cwiseSqrt());
  }
  static Eigen::Vector3d correlationOf(const Eigen::Matrix3d& covariance) noexcept;

  double angle{};                                                ///< standard deviation of the crank angle [rad]
  double speed{};                                                ///< [rad/s]
  double acceleration{};                                         ///< [rad/s2]
  double common_angle{}, common_speed{}, common_acceleration{};  ///< the part of constants of these
};

/// Motion of the links at a crank angle and slightly beside it, for gradients by the angle.
struct LinksBeside {
  LinksBeside(const HullModel& model, const LinksAtAngle& at) noexcept;
  LinksAtAngle here, beside;
};

/// covariance of (angle, speed, acceleration), linearised at the estimate (differences, good to some 1e-5), the drive's
/// reaction included. The model's own error is not in it. Some 0.3 us.
HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                            const LinksBeside& links, const HullMotion& hull,
                            const Eigen::Matrix3d& covariance) noexcept;
inline HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                                   const HullMotion& hull, const Eigen::Matrix3d& covariance) noexcept {
  return hullDeviation(model, drive, crank, LinksBeside(model, linksAt(model, crank.position.angle)), hull, covariance);
}

/// Errors of a wrench that are independent of each other, one standard deviation each, and the same in all samples: of
/// the sensor's constants, of the hammer's (their order: ConstantErrors), of the learned drive inertia, of a hull whose
/// motion is not measured. Rows: force_x [N], force_z [N], torque_y [N m].
constexpr int kInertiaColumn = ConstantErrors::kSize, kHullColumn = kInertiaColumn + 1, kLoadColumns = kHullColumn + 1;
using LoadColumns = ByConstants<3, kLoadColumns>;

/// By samples and constants together, J P J^T + (J V + dload/dp)(J V + dload/dp)^T (Schmidt's consider filter).
HullDeviation hullDeviation(const WrenchColumns& hammer, const HullModel& model, double drive_inertia,
                            const CrankEstimate& crank, const LinksBeside& links, const HullMotion& hull,
                            const CrankUncertainty& uncertainty, LoadColumns& columns) noexcept;

/// Adds what the hull's own motion adds to the deviation of the load at the links' place: linear, as the load is in all
/// but the rate. Errors of crank and IMU are independent.
void addHullMotion(const HullModel& model, const DriveReaction& drive, const LinkMotion& links, double crank_speed,
                   const HullMotion& hull, const HullMotionCovariance& covariance, HullDeviation& deviation) noexcept;

/// Standard deviation of the momentum, the drive's included: of an impulse's one end [N s, N s, N m s].
HullWrench momentumDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                             const LinksBeside& links, const Eigen::Matrix3d& covariance) noexcept;

/// Errors of the momentum that are independent of each other, one standard deviation each, in the order of LoadColumns.
/// Rows: x, z [N s].
using MomentumColumns = ByConstants<2, kLoadColumns>;

/// Errors of the links' momentum at a crank angle and a speed [rad/s]; of_speed: errors of that speed [rad/s].
MomentumColumns momentumColumns(const WrenchColumns& hammer, const HullModel& model, CrankAngle angle, double speed,
                                const Eigen::Matrix<double, 1, ConstantErrors::kSize>& of_speed) noexcept;
/// Errors of the links' weight by errors of the masses [N].
MomentumColumns weightColumns(const WrenchColumns& hammer, const HullModel& model, Gravity gravity) noexcept;

/// Samples and the sensor's constants as three errors of the load that are independent of each other, from motion of
/// the links relative to the hull; none where there is no covariance. The boom's filters take them for noise, which an
/// error of the hammer's constants, alike in all samples, is not: those are not in it.
WrenchSpread wrenchSpread(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                          const LinksBeside& links, const Eigen::Matrix3d& own, const LoadColumns& columns) noexcept;

/// Errors of constants as three that are independent of each other, one a column (rows as LoadColumns): of all of them,
/// or of the hammer's alone.
Eigen::Matrix3d constantErrors(const LoadColumns& columns) noexcept;
Eigen::Matrix3d hammerErrors(const LoadColumns& columns) noexcept;

/// Standard deviation of the crank's angle from the blow [rad]. It contains that of the angle, the zero error that the
/// readings show, and the later blow of an elastic rod. angle_std: of the angle [rad]; NaN: not known.
double deviationFromBlow(const CrankFilter& filter, double angle_std) noexcept;

/// The wrench jumps at the blow (MO-100: Fx by nearly all of its peak), so there it is one of two values and nothing
/// says which; WrenchStamped has no deviation that could. A slow crank jumps by less than 1 %, one on the mirrored
/// branch nowhere. distance: of the crank from the blow that is too close [rad]; NaN: not known.
bool isBesideBlow(const CrankEstimate& crank, double distance) noexcept;
/// Returns true if the crank is too close to the blow for its side to be known, with the uncertainty of the zero
/// included: within three standard deviations of angle and zero, or two of deviationFromBlow(). angle_std: standard
/// deviation of the angle [rad], 0 where the encoder's count shows the side as far as the zero is known. rod: answer of
/// the elastic rod's filter; empty: the rod is rigid. Before the zero is shown the mirrored branch counts as close,
/// since a wrong zero imitates a blow without a tool.
bool isBesideBlow(const CrankFilter& filter, const CrankEstimate& crank, double angle_std,
                  std::optional<bool> rod) noexcept;

}  // namespace hammer_loads
