/// All blows of a recording together: the fit of each blow's own parameters, and of those that the blows share, with an
/// honest covariance.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/calibration/segment_fit.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

/// Levenberg-Marquardt over the blow's own parameters.
void fitLocals(SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise);

/// Clears the rows and columns of the eccentricities; a matrix's first rows are the shared parameters'.
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
  GlobalMatrix covariance;        ///< covariance of globals, by the differences between the blows
  GlobalMatrix plain_covariance;  ///< covariance by the noise alone
  Noise noise;                    ///< estimated noise
  bool centred{};                 ///< eccentricities stay as they are
  std::vector<SegmentFit> fits;   ///< fits of the blows in use
  std::size_t left_out{};         ///< blows that the model does not explain (no tool, a stop)
  double mean_square{};           ///< residuals over their deviations, squared, per degree of freedom
  bool converged{};
};

/// Before anything is known of them: deviations of zero [rad], both eccentricities' parts [rad], logarithm of inertia,
/// ...
Globals priorDeviations();

/// Continues from a nearby solution, which is the prior's centre, by some steps.
void settleNear(JointFit& joint, const SegmentModel& model, const Progress& progress);

/// Gauss-Newton over the shared parameters, those of each blow eliminated (Schur); timing and speed noise from the
/// residuals meanwhile. The prior is wide, about `start`. centred: as in JointFit. The covariance is the
/// sandwich over blows with what neighbours have in common (Newey-West), at least the plain one.
JointFit fitJointly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& start,
                    const Noise& noise, bool centred, const Progress& progress = {});

}  // namespace hammer_loads::calibration
