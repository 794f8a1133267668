/// Fit of each blow's own parameters (instant, speeds, ...) with the shared parameters given.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "hammer_loads/calibration/segment_fit.h"

namespace hammer_loads::calibration {

/// The step, shortened to what the model's curvature bears.
Locals limitedLocals(const Locals& step, const Locals& at);

/// Levenberg-Marquardt over the blow's own parameters.
void fitLocals(SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise);

/// Information of a blow on the shared parameters once its own are eliminated.
struct Reduced {
  GlobalMatrix matrix;
  Globals score;
  LocalMatrix inverse;
  Eigen::Matrix<double, kLocals, kGlobals> by_global;  ///< -(change of locals per change of globals)
  Locals own;                                          ///< change of locals with globals as they are
  double angle_freedom, speed_freedom;                 ///< locals that the angles, that the speeds decide
};

Reduced reduce(const NormalEquations& e);

/// Number of free residuals among `given` ones, of which the locals determine `decided`.
inline double freeOf(double given, double decided) { return std::max(given - decided, 0.3 * given); }

/// Mean square of the angles' residuals over their deviations.
double meanSquare(const SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise);

/// Blows of a larger mean square are not of this model. mean_squares: of all blows, not empty.
double mostExplained(const std::vector<double>& mean_squares);

}  // namespace hammer_loads::calibration
