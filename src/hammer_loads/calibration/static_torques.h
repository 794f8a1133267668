/// Torques by the weight of a fitted boom, with their deviations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/calibration/boom_fit.h"

namespace hammer_loads::calibration {

/// Standard deviation of a function of the unknowns with that gradient.
double deviationOf(const BoomFit& fit, const Eigen::VectorXd& gradient);

/// Weight's torques on the joints of all cylinders [N m], one row a pose, joints as read; NaN where x makes no boom.
Eigen::MatrixXd weightTorques(const BoomModel& model, const Eigen::VectorXd& x, const std::vector<JointVector>& poses);

/// Standard deviations of WeighedLink's first moment [kg m]: x, z.
Eigen::Vector2d firstMomentDeviation(const BoomModel& model, const BoomFit& fit, std::size_t cylinder);

/// Static torque about a cylinder's joint [N m].
struct StaticTorque {
  double value{}, deviation{};  ///< standard
};
/// Static torques at poses with their uncertainty, joints as read: per pose, one for each cylinder.
std::vector<std::vector<StaticTorque>> staticTorques(const BoomModel& model, const BoomFit& fit,
                                                     const std::vector<JointVector>& poses);

}  // namespace hammer_loads::calibration
