/// All blows of a recording together: the fit of each blow's own parameters, and of those that the blows share, with an
/// honest covariance.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "hammer_loads/calibration/segment_fit.h"
#include "hammer_loads/util/progress.h"

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

using Free = Eigen::Matrix<bool, kGlobals, 1>;  ///< true for each parameter to be estimated

/// Clears the rows and columns of fixed parameters; a matrix's first rows are the shared parameters'.
template <typename Matrix>
void clearHeld(const Free& free, Matrix& covariance) {
  for (Eigen::Index k = 0; k < kGlobals; ++k)
    if (!free[k]) covariance.row(k).setZero(), covariance.col(k).setZero();
}

/// Fixes parameters by removing them from a system.
template <typename Matrix, typename Vector>
void hold(const Free& free, Matrix& matrix, Vector& score) {
  clearHeld(free, matrix);
  for (Eigen::Index k = 0; k < kGlobals; ++k)
    if (!free[k]) matrix(k, k) = 1.0, score[k] = 0.0;
}

struct JointFit {
  Globals globals;
  Globals centre;                 ///< centre of the prior of globals
  GlobalMatrix covariance;        ///< covariance of globals, by the differences between the blows
  GlobalMatrix plain_covariance;  ///< covariance by the noise alone
  Noise noise;                    ///< estimated noise
  std::vector<SegmentFit> fits;   ///< fits of the blows in use
  std::size_t left_out{};         ///< blows that the model does not explain (no tool, a stop)
  double mean_square{};           ///< residuals over their deviations, squared, per degree of freedom
  bool converged{};
};

/// Before anything is known of them: deviations of zero [rad], both eccentricities' parts [rad], logarithm of inertia,
/// ...
Globals priorDeviations();

/// Continues from a nearby solution, which is the prior's centre, by some steps.
void settleNear(JointFit& joint, const SegmentModel& model, const Free& free, const Progress& progress);

/// Gauss-Newton over the shared parameters, those of each blow eliminated (Schur); timing and speed noise from the
/// residuals meanwhile. The prior is wide, about `start`. Parameters with `free` false stay. The covariance is the
/// sandwich over blows with what neighbours have in common (Newey-West), at least the plain one.
JointFit fitJointly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& start,
                    const Noise& noise, const Free& free, const Progress& progress = {});

}  // namespace hammer_loads::calibration
