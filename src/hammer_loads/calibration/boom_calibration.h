/// Identification of a boom's masses, friction and zeros from its cylinders in two minutes of free movement.
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
  std::string name{};  ///< name of the bag, for messages
};

/// Uncertainty of the torque of weight about a joint, over the poses of the recording.
struct JointWeight {
  std::string joint;
  double torque{};     ///< static torque, rms over the poses [N m]
  double deviation{};  ///< standard deviation, rms over the poses [N m]
  double before{};     ///< difference between the given and the identified boom, rms [N m]
  double part() const { return torque > 0.0 ? deviation / torque : kInfinity; }
};

/// Residuals of a cylinder's force.
struct CylinderFit {
  std::string name;
  std::size_t rows{};
  double force{};               ///< measured force, rms [N]
  double left{};                ///< residual with the identified values, rms [N]
  double before{};              ///< residual with the given values, rms [N]
  std::vector<double> left_in;  ///< residual in each of several recordings, rms [N]; NaN: no rows there
  double held_out{};      ///< residual of the last quarter with the values of the first three, rms [N]; NaN: no rows
  double friction{};      ///< at the rms force [N]
  double friction_std{};  ///< standard deviation [N]
  /// Returns false if held-out rows fit far worse than fitted ones: the model is wrong, its deviations do not apply.
  bool holds() const { return !(held_out > std::max(kHeldOutOverLeft * left, kHeldOutOverForce * force)); }

  static constexpr double kHeldOutOverLeft = 2.0, kHeldOutOverForce = 0.04;
  // Limit: kHeldOutOverLeft, kHeldOutOverForce
};

/// Residual of one row for the picture.
struct BoomResidual {
  std::size_t cylinder{};
  double angle{};  ///< angle of the cylinder's joint [rad]
  bool extends{};
  double before{}, after{};  ///< [N]
};

/// Result of a boom identification. Estimates are keys of the boom file; their limits are not used, see joints.
struct BoomCalibration : Findings {
  /// Limit of the relative deviation of a joint's static torque. A joint above it is undetermined and no value is
  /// written, since the values belong together.
  static constexpr double kLimit = 0.03;
  // Limit: kLimit

  std::vector<std::string> names;  ///< names of the recordings
  double seconds{};
  std::size_t points{}, left_out{};
  std::vector<JointWeight> joints;
  std::vector<CylinderFit> cylinders;
  std::vector<BoomResidual> residuals;
  std::optional<Estimate> weight_check;  ///< weight on the tip according to a boom identified without it [kg]
  BoomParameters found;                  ///< boom file with all identified values and their deviations

  bool determined() const;
};

BoomCalibration calibrateBoom(const BoomBasis& basis, const std::vector<WeighedRecording>& recordings,
                              const Progress& progress = {});

}  // namespace hammer_loads::calibration
