#include "hammer_loads/boom/body_motion.h"

#include <kdl/chain.hpp>

#include "hammer_loads/util/inline.h"

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

HAMMER_LOADS_INLINE Eigen::Vector3d accelerationAt(const BodyMotion& m, const Eigen::Vector3d& r) noexcept {
  return m.acceleration + m.angular_acceleration.cross(r) + m.rate.cross(m.rate.cross(r));
}

PlacedBody placed(const RigidBody& body, const Pose& X_BL) noexcept {
  const Eigen::Matrix3d R = X_BL.linear();
  return {body.mass, R * body.com, R * body.inertia * R.transpose()};
}

HAMMER_LOADS_INLINE Wrench loadOf(const PlacedBody& body, const Pose& X_BL, const BodyMotion& m) noexcept {
  const Eigen::Vector3d force = -body.mass * accelerationAt(m, body.com);
  const Eigen::Vector3d moment = body.inertia * m.angular_acceleration + m.rate.cross(body.inertia * m.rate);
  return {force, (X_BL.translation() + body.com).cross(force) - moment};
}

/// root_acceleration: against gravity it stands for the weight.
void findMotions(const Chain& chain, const ChainPose& pose, const JointMotion& motion,
                 const Eigen::Vector3d& root_acceleration, std::array<BodyMotion, kMaxLinks>& result) noexcept {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  BodyMotion now{none, none, root_acceleration};  // of the link before, until it is that of the link itself
  Eigen::Vector3d origin = none;
  result[0] = now;
  for (int i = 1; i < chain.links(); ++i) {
    const Eigen::Vector3d p = pose.link(i).translation();
    now.acceleration = accelerationAt(now, p - origin);
    origin = p;
    const int joint = chain.link(i).joint;
    if (joint >= 0) {
      const Eigen::Vector3d& axis = pose.axis_B[static_cast<std::size_t>(joint)];
      const Eigen::Vector3d turned = now.rate.cross(axis);
      const double velocity = motion.velocity[joint], acceleration = motion.acceleration[joint];
      if (pose.prismatic[static_cast<std::size_t>(joint)]) {
        now.acceleration += acceleration * axis + (2.0 * velocity) * turned;
      } else {
        now.rate += velocity * axis;
        now.angular_acceleration += acceleration * axis + velocity * turned;
      }
    }
    result[static_cast<std::size_t>(i)] = now;
  }
}

}  // namespace

std::vector<RigidBody> bodiesOf(const Chain& chain) {
  std::vector<RigidBody> bodies(1);
  for (const KDL::Segment& segment : chain.kdl().segments) bodies.push_back(bodyOf(segment));
  return bodies;
}

void placeBodies(const std::vector<RigidBody>& bodies, const ChainPose& pose, PlacedBodies& result) noexcept {
  for (std::size_t i = 1; i < bodies.size(); ++i) result[i] = placed(bodies[i], pose.X_BL[i]);
}

void findChainLoads(const Chain& chain, const PlacedBodies& bodies, const ChainPose& pose, const JointMotion& motion,
                    const Eigen::Vector3d& g_B, ChainLoads& result) noexcept {
  findMotions(chain, pose, motion, -g_B, result.motion);
  Wrench load;
  for (int i = chain.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    result.beyond[here] = load = load + loadOf(bodies[here], pose.link(i), result.motion[here]);
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
  return loadOf(placed(body, X_BL), X_BL, motion);
}

}  // namespace hammer_loads
