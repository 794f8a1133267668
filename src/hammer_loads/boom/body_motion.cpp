#include "hammer_loads/boom/body_motion.h"

#include <kdl/chain.hpp>

namespace hammer_loads {
namespace {

RigidBody bodyOf(const KDL::Segment& segment) {
  KDL::RigidBodyInertia given = segment.getInertia();  // its RefPoint() is not const
  RigidBody body;
  body.mass = given.getMass();
  const KDL::Vector com = given.getCOG();
  body.com = {com.x(), com.y(), com.z()};
  const KDL::RotationalInertia about_com = given.RefPoint(com).getRotationalInertia();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) body.inertia(r, c) = about_com.data[3 * r + c];
  }
  return body;
}

/// root_acceleration: against gravity it stands for the weight.
void findMotions(const Chain& chain, const ChainPose& pose, const JointMotion& motion,
                 const Eigen::Vector3d& root_acceleration, std::array<BodyMotion, kMaxLinks>& result) noexcept {
  // Of the link before, until it is that of the link itself.
  BodyMotion now{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), root_acceleration};
  result[0] = now;
  for (int i = 1; i < chain.links(); ++i) {
    const auto here = static_cast<std::size_t>(i);
    now.acceleration = now.accelerationAt(pose.X_BL[here].translation() - pose.X_BL[here - 1].translation());
    const int joint = chain.link(i).joint;
    if (joint >= 0) {
      const Eigen::Vector3d& axis = pose.axis_B[static_cast<std::size_t>(joint)];
      const double velocity = motion.velocity[joint], acceleration = motion.acceleration[joint];
      const Eigen::Vector3d turned = now.rate.cross(axis);
      if (pose.prismatic[static_cast<std::size_t>(joint)]) {
        now.acceleration += acceleration * axis + (2.0 * velocity) * turned;
      } else {
        now.rate += velocity * axis;
        now.angular_acceleration += acceleration * axis + velocity * turned;
      }
    }
    result[here] = now;
  }
}

}  // namespace

std::vector<RigidBody> bodiesOf(const Chain& chain) {
  std::vector<RigidBody> bodies(1);
  for (const KDL::Segment& segment : chain.kdl().segments) bodies.push_back(bodyOf(segment));
  return bodies;
}

void findChainLoads(const Chain& chain, const std::vector<RigidBody>& bodies, const ChainPose& pose,
                    const JointMotion& motion, const Eigen::Vector3d& g_B, ChainLoads& result) noexcept {
  findMotions(chain, pose, motion, -g_B, result.motion);
  Wrench load;
  for (int i = chain.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    load = load + bodyLoad(bodies[here], pose.link(i), result.motion[here]);
    result.beyond[here] = load;
  }
}

JointVector jointTorque(const Chain& chain, const ChainPose& pose, const ChainLoads& loads) noexcept {
  JointVector torque(pose.joints);
  for (int j = 0; j < pose.joints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const Wrench& load = loads.beyond[static_cast<std::size_t>(chain.linkBeyond(j))];
    torque[j] = pose.prismatic[i] ? pose.axis_B[i].dot(load.force)
                                  : pose.axis_B[i].dot(load.torque - pose.p_BJ_B[i].cross(load.force));
  }
  return torque;
}

Wrench bodyLoad(const RigidBody& body, const Pose& X_BL, const BodyMotion& motion) noexcept {
  const Eigen::Matrix3d& R = X_BL.linear();
  const Eigen::Vector3d r = R * body.com;
  const Eigen::Vector3d rate_L = R.transpose() * motion.rate;
  const Eigen::Vector3d moment_L =
      body.inertia * (R.transpose() * motion.angular_acceleration) + rate_L.cross(body.inertia * rate_L);
  Wrench load;
  load.force = -body.mass * motion.accelerationAt(r);
  load.torque = (X_BL.translation() + r).cross(load.force) - R * moment_L;
  return load;
}

}  // namespace hammer_loads
