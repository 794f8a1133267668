#include "hammer_loads/calibration/static_torques.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::calibration {
namespace {

/// First moment about a cylinder's joint of all that its link carries, in the axes of the link that stands for it; what
/// is beyond the next joint counts as in that. x and z.
Eigen::Vector2d firstMoment(const Boom& boom, int joint, int link) {
  const Chain& chain = boom.chain();
  ChainPose pose;
  forwardKinematics(chain, JointVector::Zero(chain.joints()), pose);
  const int first = chain.linkBeyond(joint);
  int last = first + 1;
  while (last < chain.links() && chain.link(last).joint < 0) ++last;
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();
  for (int i = first; i < chain.links(); ++i) {
    const RigidBody& body = chain.link(i).body;
    const Eigen::Vector3d at_B =
        i < last ? Eigen::Vector3d(pose.link(i) * body.com) : Eigen::Vector3d(pose.link(last).translation());
    moment_B += body.mass * (at_B - pose.p_BJ_B[static_cast<std::size_t>(joint)]);
  }
  const Eigen::Vector3d moment = pose.link(link).linear().transpose() * moment_B;
  return {moment.x(), moment.z()};
}

}  // namespace

double deviationOf(const BoomFit& fit, const Eigen::VectorXd& gradient) {
  return std::sqrt(std::max(0.0, gradient.dot(fit.covariance * gradient)));
}

/// Weight's torques on the joints of all cylinders, one row a pose; joints as read.
Eigen::MatrixXd weightTorques(const BoomModel& model, const Eigen::VectorXd& x, const std::vector<JointVector>& poses) {
  const std::vector<Cylinder>& cylinders = model.given().cylinders();
  Eigen::MatrixXd torques(static_cast<Eigen::Index>(poses.size()), static_cast<Eigen::Index>(cylinders.size()));
  const std::optional<Boom> boom = model.boomAt(x);
  if (!boom) return torques.setConstant(kNaN);
  for (std::size_t p = 0; p < poses.size(); ++p) {
    JointVector position = poses[p];
    for (std::size_t k = 0; k < cylinders.size(); ++k) position[cylinders[k].joint()] -= model.jointZero(x, k);
    ChainPose pose;
    forwardKinematics(boom->chain(), position, pose);
    const JointVector torque = jointTorqueOfWeight(boom->chain(), pose, model.basis().g_B);
    for (std::size_t k = 0; k < cylinders.size(); ++k)
      torques(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k)) = torque[cylinders[k].joint()];
  }
  return torques;
}

Eigen::Vector2d firstMomentDeviation(const BoomModel& model, const BoomFit& fit, std::size_t cylinder) {
  const int joint = model.given().cylinders()[cylinder].joint(), link = model.linkOf(cylinder);
  Eigen::Vector2d deviation;
  for (const int axis : {0, 1}) {
    const auto moment = [&](const Eigen::VectorXd& x) {
      const std::optional<Boom> boom = model.boomAt(x);
      return boom ? firstMoment(*boom, joint, link)[axis] : kNaN;
    };
    deviation[axis] = deviationOf(fit, gradientOf(moment, fit.x));
  }
  return deviation;
}

std::vector<std::vector<StaticTorque>> staticTorques(const BoomModel& model, const BoomFit& fit,
                                                     const std::vector<JointVector>& poses) {
  const Eigen::MatrixXd value = weightTorques(model, fit.x, poses);
  std::vector<Eigen::MatrixXd> slopes;
  constexpr double kStep = 0.1;  // step of differences, in standard deviations before the recording
  // Numerical: kStep
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    Eigen::VectorXd up = fit.x, down = fit.x;
    up[i] += kStep, down[i] -= kStep;
    slopes.emplace_back((weightTorques(model, up, poses) - weightTorques(model, down, poses)) / (2.0 * kStep));
  }
  std::vector<std::vector<StaticTorque>> result(poses.size());
  Eigen::VectorXd gradient(fit.x.size());
  for (Eigen::Index p = 0; p < value.rows(); ++p) {
    for (Eigen::Index k = 0; k < value.cols(); ++k) {
      for (Eigen::Index i = 0; i < fit.x.size(); ++i) gradient[i] = slopes[static_cast<std::size_t>(i)](p, k);
      result[static_cast<std::size_t>(p)].push_back({value(p, k), deviationOf(fit, gradient)});
    }
  }
  return result;
}

}  // namespace hammer_loads::calibration
