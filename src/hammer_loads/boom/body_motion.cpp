#include "hammer_loads/boom/body_motion.h"

#include <kdl/chain.hpp>

#include "hammer_loads/boom/lanes.h"
#include "hammer_loads/util/avx2.h"

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

struct MotionInLanes {
  Lanes rate, angular_acceleration, acceleration;
};

HAMMER_LOADS_INLINE void storeMotion(const MotionInLanes& m, BodyMotion& to) noexcept {
  store(m.rate, to.rate.data()), store(m.angular_acceleration, to.angular_acceleration.data());
  store(m.acceleration, to.acceleration.data());
}

HAMMER_LOADS_INLINE Lanes accelerationAt(const MotionInLanes& m, const Lanes& r) noexcept {
  return m.acceleration + cross(m.angular_acceleration, r) + cross(m.rate, cross(m.rate, r));
}

/// R I R^T, symmetric but for rounding.
HAMMER_LOADS_INLINE void place(const RigidBody& body, const Pose& X_BL, PlacedBody& placed) noexcept {
  const double* R = X_BL.data();
  const double* I = body.inertia.data();
  placed.mass = body.mass;
  store(product(R, body.com.data()), placed.com.data());
  const Lanes RI[3] = {product(R, I), product(R, I + 3), product(R, I + 6)};
  for (int c = 0; c < 3; ++c)
    store(RI[0] * R[c] + RI[1] * R[4 + c] + RI[2] * R[8 + c], &placed.inertia[4 * std::size_t(c)]);
}

HAMMER_LOADS_INLINE LaneWrench loadOf(const PlacedBody& body, const Pose& X_BL, const BodyMotion& m) noexcept {
  const Lanes r = lanesAt(body.com.data()), rate = lanesAt(m.rate.data());
  const Lanes acceleration =
      accelerationAt({rate, lanesAt(m.angular_acceleration.data()), lanesAt(m.acceleration.data())}, r);
  const Lanes moment = product(body.inertia.data(), m.angular_acceleration.data()) +
                       cross(rate, product(body.inertia.data(), m.rate.data()));
  const Lanes force = -body.mass * acceleration;
  return {force, cross(originOf(X_BL) + r, force) - moment};
}

/// root_acceleration: against gravity it stands for the weight.
HAMMER_LOADS_INLINE void findMotions(const Chain& chain, const ChainPose& pose, const JointMotion& motion,
                                     const Lanes& root_acceleration,
                                     std::array<BodyMotion, kMaxLinks>& result) noexcept {
  MotionInLanes now{{}, {}, root_acceleration};  // of the link before, until it is that of the link itself
  Lanes origin{};
  storeMotion(now, result[0]);
  for (int i = 1; i < chain.links(); ++i) {
    const auto here = static_cast<std::size_t>(i);
    const Lanes p = originOf(pose.X_BL[here]);
    now.acceleration = accelerationAt(now, p - origin);
    origin = p;
    const int joint = chain.link(i).joint;
    if (joint >= 0) {
      const Lanes axis = lanesOf(pose.axis_B[static_cast<std::size_t>(joint)]), turned = cross(now.rate, axis);
      const double velocity = motion.velocity[joint], acceleration = motion.acceleration[joint];
      if (pose.prismatic[static_cast<std::size_t>(joint)]) {
        now.acceleration += acceleration * axis + (2.0 * velocity) * turned;
      } else {
        now.rate += velocity * axis;
        now.angular_acceleration += acceleration * axis + velocity * turned;
      }
    }
    storeMotion(now, result[here]);
  }
}

HAMMER_LOADS_INLINE void findChainLoadsAny(const Chain& chain, const PlacedBodies& bodies, const ChainPose& pose,
                                           const JointMotion& motion, const Eigen::Vector3d& g_B,
                                           ChainLoads& result) noexcept {
  findMotions(chain, pose, motion, -lanesOf(g_B), result.motion);
  LaneWrench load{};
  for (int i = chain.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    add(loadOf(bodies[here], pose.link(i), result.motion[here]), load);
    store(load, result.beyond[here]);
  }
}
HAMMER_LOADS_AVX2 void findChainLoadsAvx2(const Chain& chain, const PlacedBodies& bodies, const ChainPose& pose,
                                          const JointMotion& motion, const Eigen::Vector3d& g_B,
                                          ChainLoads& result) noexcept {
  findChainLoadsAny(chain, bodies, pose, motion, g_B, result);
}

HAMMER_LOADS_INLINE void placeBodiesAny(const std::vector<RigidBody>& bodies, const ChainPose& pose,
                                        PlacedBodies& placed) noexcept {
  for (std::size_t i = 1; i < bodies.size(); ++i) place(bodies[i], pose.X_BL[i], placed[i]);
}
HAMMER_LOADS_AVX2 void placeBodiesAvx2(const std::vector<RigidBody>& bodies, const ChainPose& pose,
                                       PlacedBodies& placed) noexcept {
  placeBodiesAny(bodies, pose, placed);
}

HAMMER_LOADS_INLINE void findBodyLoadAny(const RigidBody& body, const Pose& X_BL, const BodyMotion& motion,
                                         Wrench& load) noexcept {
  PlacedBody placed;
  place(body, X_BL, placed);
  store(loadOf(placed, X_BL, motion), load);
}
HAMMER_LOADS_AVX2 void findBodyLoadAvx2(const RigidBody& body, const Pose& X_BL, const BodyMotion& motion,
                                        Wrench& load) noexcept {
  findBodyLoadAny(body, X_BL, motion, load);
}

}  // namespace

std::vector<RigidBody> bodiesOf(const Chain& chain) {
  std::vector<RigidBody> bodies(1);
  for (const KDL::Segment& segment : chain.kdl().segments) bodies.push_back(bodyOf(segment));
  return bodies;
}

void placeBodies(const std::vector<RigidBody>& bodies, const ChainPose& pose, PlacedBodies& placed) noexcept {
  if (kHasAvx2) return placeBodiesAvx2(bodies, pose, placed);
  placeBodiesAny(bodies, pose, placed);
}

void findChainLoads(const Chain& chain, const PlacedBodies& bodies, const ChainPose& pose, const JointMotion& motion,
                    const Eigen::Vector3d& g_B, ChainLoads& result) noexcept {
  if (kHasAvx2) return findChainLoadsAvx2(chain, bodies, pose, motion, g_B, result);
  findChainLoadsAny(chain, bodies, pose, motion, g_B, result);
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
  Wrench load;
  if (kHasAvx2) {
    findBodyLoadAvx2(body, X_BL, motion, load);
  } else {
    findBodyLoadAny(body, X_BL, motion, load);
  }
  return load;
}

}  // namespace hammer_loads
