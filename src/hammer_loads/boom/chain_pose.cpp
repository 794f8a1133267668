#include "hammer_loads/boom/chain_pose.h"

#include "hammer_loads/util/functions.h"

namespace hammer_loads {

void forwardKinematics(const Chain& chain, const JointVector& position, ChainPose& pose) noexcept {
  pose.links = chain.links();
  pose.joints = chain.joints();
  pose.X_BL[0].setIdentity();
  for (int i = 1; i < pose.links; ++i) {
    const ChainLink& link = chain.link(i);
    const Pose& X_BP = pose.X_BL[static_cast<std::size_t>(i - 1)];
    Pose& X_BL = pose.X_BL[static_cast<std::size_t>(i)];
    Eigen::Matrix3d R_PL = link.steady;
    Eigen::Vector3d p_PL = link.origin;
    if (link.joint >= 0) {
      const auto joint = static_cast<std::size_t>(link.joint);
      const double q = position[link.joint];
      const auto [sin_q, cos_q] = link.prismatic ? SineCosine{} : sineCosine(q);
      R_PL += sin_q * link.sine + cos_q * link.cosine;
      p_PL += q * link.slide;
      pose.axis_B[joint] = X_BP.linear() * link.axis;
      pose.prismatic[joint] = link.prismatic;
      pose.sine[joint] = sin_q, pose.cosine[joint] = cos_q;
    }
    X_BL.linear() = X_BP.linear() * R_PL;
    X_BL.translation() = X_BP * p_PL;
    if (link.joint >= 0) pose.p_BJ_B[static_cast<std::size_t>(link.joint)] = X_BL.translation();
  }
}

Jacobian tipJacobian(const ChainPose& pose) noexcept {
  Jacobian J(6, pose.joints);
  const Pose& X_BT = pose.tip();
  for (int j = 0; j < pose.joints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const Eigen::Vector3d axis_T = X_BT.linear().transpose() * pose.axis_B[i];
    if (pose.prismatic[i]) {
      J.col(j) << axis_T, Eigen::Vector3d::Zero();
    } else {
      const Eigen::Vector3d p_JT_T = X_BT.linear().transpose() * (X_BT.translation() - pose.p_BJ_B[i]);
      J.col(j) << axis_T.cross(p_JT_T), axis_T;
    }
  }
  return J;
}

Wrench wrenchAtLink(const ChainPose& pose, int link, const Wrench& w_tip) noexcept {
  return shifted(pose.link(link).inverse() * pose.tip(), w_tip);
}

JointVector jointTorqueOfWeight(const Chain& chain, const ChainPose& pose, const Eigen::Vector3d& g_B) noexcept {
  JointVector torque(pose.joints);
  double mass = 0.0;
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  // first moment of the links from the tip to this one
  for (int i = pose.links - 1; i > 0; --i) {
    const ChainLink& link = chain.link(i);
    mass += link.body.mass;
    moment_B += link.body.mass * (pose.link(i) * link.body.com);
    if (link.joint < 0) continue;
    const auto j = static_cast<std::size_t>(link.joint);
    torque[link.joint] = link.prismatic ? mass * pose.axis_B[j].dot(g_B)
                                        : pose.axis_B[j].dot((moment_B - mass * pose.p_BJ_B[j]).cross(g_B));
  }
  return torque;
}

PointMass massFrom(const Chain& chain, const ChainPose& pose, int first) noexcept {
  PointMass all;
  for (int i = first; i < pose.links; ++i) {
    const RigidBody& body = chain.link(i).body;
    all.mass += body.mass;
    all.p += body.mass * (pose.link(i) * body.com);
  }
  if (all.mass > 0.0) all.p /= all.mass;
  return all;
}

}  // namespace hammer_loads
