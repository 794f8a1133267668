/// Weighing of a boom by its own cylinders: masses, friction and zeros from two minutes of free movement.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/calibration/boom_fit.h"
#include "hammer_loads/calibration/findings.h"

namespace hammer_loads::calibration {

/// A recording and the weight on the tip during it.
struct WeighedRecording {
  BoomRecording recording;
  TipWeight weight;
  std::string name{};  ///< name of its bag, for texts
};

/// Uncertainty of the weight beyond a joint, over the poses of the recording.
struct JointWeight {
  std::string joint;
  double torque{};     ///< static, rms over the poses [N m]
  double deviation{};  ///< standard, rms as above [N m]
  double before{};     ///< difference of the given boom from the identified one, rms [N m]
  double part() const { return torque > 0.0 ? deviation / torque : kInfinity; }
};

/// Residual of a cylinder's force.
struct CylinderFit {
  std::string name;
  std::size_t rows{};
  double force{};               ///< rms [N]
  double left{};                ///< rms, with the values found [N]
  double before{};              ///< rms, with those given [N]
  std::vector<double> left_in;  ///< left in each recording, where there are several [N]; NaN: no rows there
  double held_out{};            ///< rms of the last quarter with the values of the first three [N]; NaN: no rows there
  double friction{};            ///< at that force [N]
  double friction_std{};        ///< standard [N]
  /// True if held-out rows fit far worse than fitted ones, so that the model is wrong and its deviations do not apply.
  bool holds() const { return !(held_out > std::max(kHeldOutOverLeft * left, kHeldOutOverForce * force)); }

  static constexpr double kHeldOutOverLeft = 2.0, kHeldOutOverForce = 0.04;
  // Limit: kHeldOutOverLeft, kHeldOutOverForce
};

/// One row as a picture shows it.
struct BoomResidual {
  std::size_t cylinder{};
  double angle{};  ///< angle of its joint [rad]
  bool extends{};
  double before{}, after{};  ///< [N]
};

/// Estimates are keys of the boom file; their limits are not used, see joints.
struct BoomCalibration : Findings {
  /// Limit of the relative deviation of a joint's static torque. Above it the joint is undetermined and nothing is
  /// written, since the values belong together.
  static constexpr double kLimit = 0.03;
  // Limit: kLimit

  std::vector<std::string> names;  ///< names of the recordings
  double seconds{};
  std::size_t points{}, left_out{};
  std::vector<JointWeight> joints;
  std::vector<CylinderFit> cylinders;
  std::vector<BoomResidual> residuals;
  std::optional<Estimate> weight_check;  ///< the weight on the tip by a boom that was weighed without it [kg]
  BoomParameters found;                  ///< boom file with everything found and its deviations

  bool determined() const;
};

BoomCalibration calibrateBoom(const BoomBasis& basis, const std::vector<WeighedRecording>& recordings,
                              const Progress& progress = {});

}  // namespace hammer_loads::calibration
