/// A crank sample, and the estimate of the crank at an instant with its uncertainty.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/link_motion.h"

namespace hammer_loads {

/// One crank sample as measured.
struct CrankSample {
  double angle{};               ///< any winding [rad]
  std::optional<double> speed;  ///< [rad/s]
};

/// Best estimate at an instant.
struct CrankEstimate {
  CrankPosition position;
  double speed{};         ///< [rad/s]
  double acceleration{};  ///< [rad/s2]
};

/// Uncertainty of an estimate due to errors that are independent between samples, and due to constants, whose errors
/// are equal in all samples.
struct CrankUncertainty {
  enum Row : Eigen::Index { kAngle, kSpeed, kAcceleration, kInertia };

  Eigen::Matrix3d own{Eigen::Matrix3d::Zero()};  ///< covariance of angle [rad], speed [rad/s], acceleration [rad/s2]
  /// Effects of independent errors of one standard deviation each. Rows as above, the last one relative to the drive's
  /// inertia.
  ByConstants<4, ConstantErrors::kSize> by_constant{ByConstants<4, ConstantErrors::kSize>::Zero()};
  double inertia{};  ///< relative standard deviation of the drive's inertia, without the part of the constants

  /// Errors of the speed at a given crank angle; an error of the angle shifts the instant at which it is passed. rate:
  /// acceleration over speed [1/s].
  ConstantErrors::Row speedAtAngle(double rate) const noexcept {
    return by_constant.row(kSpeed) - static_cast<float>(rate) * by_constant.row(kAngle);
  }
  Eigen::Matrix3d covariance() const noexcept;
};

/// The crank at one place between two samples: predicted forward from the earlier one and backward from the later one.
struct CrankPaths {
  CrankEstimate forward, back;
};

/// Factor of a blow: crank speed after it over that before. Standard deviations exclude the part of the constants.
struct BlowFactor {
  double mean{1.0};                                            ///< [-]
  double deviation{std::numeric_limits<double>::quiet_NaN()};  ///< [-]
  double drive_inertia{};  ///< Jc, on which the blow acts; gives the restitution [kg m2]; 0: not known
  double inertia_std{};    ///< relative [-]
  bool early{};            ///< true if it acted before the dead centre, which the crank passed at the changed speed
  /// Changes of the factor [-] and relative changes of the inertia by independent errors of constants, one standard
  /// deviation each.
  ByConstants<2, ConstantErrors::kSize> by_constant{ByConstants<2, ConstantErrors::kSize>::Zero()};
};

/// Result of processing a sample.
enum class Tracking {
  kContinued,  ///< agrees with what came before
  kRestarted,  ///< restarted at this sample; the motion before it is not known
  kRevised,    ///< continues with a revised contact: the last passage was no blow, or was one
  kOutlier,    ///< contradicts the prediction and was ignored; a second one like it restarts
};

}  // namespace hammer_loads
