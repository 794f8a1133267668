/// Joint estimate of sensor and hammer constants: errors in the data sheet resemble errors of the sensor.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/joint_fit.h"

namespace hammer_loads::calibration {

/// Joint estimate of the shared parameters and the hammer's constants. Each constant has a prior about the file's
/// value, so that an effect that it can explain is not attributed to the sensor.
struct HammerPart {
  Globals globals;
  std::vector<std::string> names;  ///< keys of the constants, or a level for the effects that it neglects
  Eigen::VectorXd errors;  ///< errors of the constants, true less file's [their standard deviations], with the signs of
                           ///< MachineColumns
  Eigen::MatrixXd covariance;  ///< from the noise alone: shared parameters, then constants [rad, ..., as above]

  bool has(const std::string& constant) const;
  /// Returns the name of a row of the covariance.
  std::string nameOf(Eigen::Index row) const;
  /// Returns the ratio of a constant's standard deviation to its prior one.
  double left(std::size_t constant) const {
    const auto at = kGlobals + static_cast<Eigen::Index>(constant);
    return std::sqrt(covariance(at, at));
  }
  /// Widens the covariance by the differences between blows beyond the noise, which the covariance of `fit` contains.
  void widen(const JointFit& fit);
  /// Applies a prior for the usual mounting eccentricity of an encoder, where the constants hide it.
  void weighByMounting();
  /// Returns false if the blows differ so much that a shared parameter is far less certain than its prior.
  bool isCertain() const;
};

/// Estimates the hammer's constants from a fit with the file's values; an exact hammer has none. It makes two steps of
/// least squares, with the motion's derivatives by differences: some 20 runs of a blow each.
HammerPart findWithHammer(JointFit joint, const SegmentModel& model);

/// Subtracts the bias that noise causes. Noise biases the parameters of each blow, and thereby the shared ones, in the
/// same direction, so that more blows do not average it out. Recordings are simulated from the fit, with its noise and
/// the counts, and fitted again; their mean error is the bias. Pairs of opposite errors leave no error of first order.
/// count: step of the encoder in `seen` [rad]; 0: none.
void removeBias(JointFit& joint, HammerPart& hammer, const SegmentModel& model, double count,
                const Progress& progress = {});

}  // namespace hammer_loads::calibration
