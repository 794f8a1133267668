/// What the hammer's constants may have of what was found: a drawing that is off looks like a sensor that is.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/joint_fit.h"

namespace hammer_loads::calibration {

/// The shared parameters and the hammer's constants, found together: each constant has a prior of its standard
/// deviation about the file's value, so that what it explains as well is not the sensor's.
struct HammerPart {
  Globals globals;
  std::vector<std::string> names;  ///< keys of the constants; a level for what that leaves out
  Eigen::VectorXd errors;  ///< of the constants, true less file's [their standard deviations], as MachineColumns has
                           ///< their signs
  Eigen::MatrixXd covariance;  ///< of shared parameters, then constants [rad, ..., as above], by the noise alone
  Eigen::VectorXd prior;       ///< inverse variances of the same before any reading

  bool has(const std::string& constant) const;
  /// Of a row of the covariance.
  std::string nameOf(Eigen::Index row) const;
  /// Of the constants, the part of its standard deviation that is left.
  double left(std::size_t constant) const {
    const auto at = kGlobals + static_cast<Eigen::Index>(constant);
    return std::sqrt(covariance(at, at));
  }
  /// What blows differ by beyond the noise is in the shared parameters of a fit; here as well.
  void widen(const JointFit& fit);
};

/// From a fit with the file's constants. free: as in the fit; the others stay. A hammer that is exact has no constants
/// to find. Two steps of least squares, the motion of the constants' hammers by differences; some 20 runs of a blow
/// each.
HammerPart findWithHammer(JointFit joint, const SegmentModel& model, const Free& free);

/// With noise, what each blow has of its own is bent the same way at every blow, and what they share with it: no number
/// of blows averages that out. So recordings are made up from the fit, with its noise and the counts, and fitted again;
/// what they are off on the mean is taken off both. count: of the encoder, in `seen` [rad]; 0: none.
void removeBias(JointFit& joint, HammerPart& hammer, const SegmentModel& model, const Free& free, double count,
                const Progress& progress = {});

}  // namespace hammer_loads::calibration
