/// Joint estimate of sensor and hammer constants: an error in the data sheet looks like one of the sensor.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/joint_fit.h"

namespace hammer_loads::calibration {

/// Joint estimate of the shared parameters and the hammer's constants. Each constant has a prior about the file's
/// value, so that an effect that it can explain is not attributed to the sensor.
struct HammerPart {
  Globals globals;
  std::vector<std::string> names;  ///< keys of the constants; a level for what that leaves out
  Eigen::VectorXd errors;  ///< errors of the constants, true less file's [their standard deviations], with the signs of
                           ///< MachineColumns
  Eigen::MatrixXd covariance;  ///< by the noise alone: shared parameters, then constants [rad, ..., as above]

  bool has(const std::string& constant) const;
  /// Name of a row of the covariance.
  std::string nameOf(Eigen::Index row) const;
  /// Standard deviation of a constant over that before the recording.
  double left(std::size_t constant) const {
    const auto at = kGlobals + static_cast<Eigen::Index>(constant);
    return std::sqrt(covariance(at, at));
  }
  /// Adds the differences between blows beyond the noise, which the covariance of a fit's shared parameters contains.
  void widen(const JointFit& fit);
  /// Takes into account how far from its centre an encoder is usually mounted, where the constants hide it.
  void weighByMounting();
  /// False if the blows differ so much that a shared parameter is far less certain than before the recording.
  bool isCertain() const;
};

/// From a fit with the file's constants. A hammer that is exact has no constants to find. Two steps of least squares,
/// the motion of the constants' hammers by differences; some 20 runs of a blow each.
HammerPart findWithHammer(JointFit joint, const SegmentModel& model);

/// Noise biases the parameters of each blow, and thereby the shared ones, in the same direction at every blow, so that
/// more blows do not average it out. Recordings are therefore simulated from the fit, with its noise and the counts,
/// and fitted again; their mean error is subtracted from both. Pairs of opposite errors leave no error of first order.
/// count: of the encoder, in `seen` [rad]; 0: none.
void removeBias(JointFit& joint, HammerPart& hammer, const SegmentModel& model, double count,
                const Progress& progress = {});

}  // namespace hammer_loads::calibration
