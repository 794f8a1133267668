/// Joint fit of all blows of a recording: each blow's own parameters and the shared ones, with a covariance that
/// includes differences between the blows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/calibration/segment_fit.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

/// Fits the blow's own parameters by Levenberg-Marquardt.
void fitLocals(SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise);

/// Clears the rows and columns of the eccentricities; the shared parameters must be first in the matrix.
template <typename Matrix>
void clearEccentricity(Matrix& covariance) {
  covariance.template middleRows<4>(kSine1).setZero();
  covariance.template middleCols<4>(kSine1).setZero();
}

/// Fixes the eccentricities by removing them from a system.
template <typename Matrix, typename Vector>
void holdEccentricity(Matrix& matrix, Vector& score) {
  clearEccentricity(matrix);
  matrix.diagonal().template segment<4>(kSine1).setOnes();
  score.template segment<4>(kSine1).setZero();
}

struct JointFit {
  Globals globals;
  Globals centre;                 ///< centre of the prior of globals
  GlobalMatrix covariance;        ///< covariance of globals, from the differences between the blows
  GlobalMatrix plain_covariance;  ///< covariance from the noise alone
  Noise noise;                    ///< estimated noise
  bool centred{};                 ///< eccentricities are held fixed
  std::vector<SegmentFit> fits;   ///< fits of the blows in use
  std::size_t left_out{};         ///< blows that the model does not explain (no tool, a stop)
  double mean_square{};           ///< squared residuals over their variances, per degree of freedom
  bool converged{};
};

/// Returns the prior standard deviations of the shared parameters: zero [rad], both eccentricities' parts [rad],
/// logarithm of inertia, ...
Globals priorDeviations();

/// Continues by some steps from a nearby solution, which becomes the centre of the prior.
void settleNear(JointFit& joint, const SegmentModel& model, const Progress& progress);

/// Fits the shared parameters by Gauss-Newton, with those of each blow eliminated (Schur), and estimates timing and
/// speed noise from the residuals. The prior is wide, about `start`. centred: as in JointFit. The covariance is the
/// sandwich over blows with correlated neighbours (Newey-West), at least the plain one.
JointFit fitJointly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& start,
                    const Noise& noise, bool centred, const Progress& progress = {});

}  // namespace hammer_loads::calibration
