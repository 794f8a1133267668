#include "hammer_loads/boom/chain_dynamics.h"

#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>

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

struct ChainDynamics::Solvers {
  explicit Solvers(const Chain& given)
      : chain(given),
        composite_bodies(chain.kdl(), KDL::Vector::Zero()),
        position(chain.kdl().getNrOfJoints()),
        mass(chain.kdl().getNrOfJoints()),
        bodies(bodiesOf(given)) {}

  Chain chain;  ///< keeps alive what the solvers refer to
  KDL::ChainDynParam composite_bodies;
  KDL::JntArray position;
  KDL::JntSpaceInertiaMatrix mass;
  std::vector<RigidBody> bodies;
};

ChainDynamics::ChainDynamics(const Chain& chain) : solvers_(std::make_unique<Solvers>(chain)) {}
ChainDynamics::~ChainDynamics() = default;
ChainDynamics::ChainDynamics(const ChainDynamics& other) : ChainDynamics(other.solvers_->chain) {}
ChainDynamics& ChainDynamics::operator=(const ChainDynamics& other) { return *this = ChainDynamics(other); }
ChainDynamics::ChainDynamics(ChainDynamics&&) noexcept = default;
ChainDynamics& ChainDynamics::operator=(ChainDynamics&&) noexcept = default;

void ChainDynamics::place(const ChainPose& pose, PlacedBodies& bodies) const noexcept {
  placeBodies(solvers_->bodies, pose, bodies);
}

JointVector ChainDynamics::torqueOfMotion(const ChainPose& pose, const PlacedBodies& bodies,
                                          const JointMotion& motion) const noexcept {
  const Chain& chain = solvers_->chain;
  if (motion.velocity.isZero(0.0) && motion.acceleration.isZero(0.0)) return JointVector::Zero(chain.joints());
  ChainLoads loads;
  chainLoads(pose, bodies, motion, Eigen::Vector3d::Zero(), loads);
  return jointTorque(chain, pose, loads);
}

void ChainDynamics::chainLoads(const ChainPose& pose, const PlacedBodies& bodies, const JointMotion& motion,
                               const Eigen::Vector3d& g_B, ChainLoads& result) const noexcept {
  findChainLoads(solvers_->chain, bodies, pose, motion, g_B, result);
}

/// Second derivatives of the weight's potential: a joint turns everything beyond it, or slides it, against gravity.
JointMatrix ChainDynamics::weightStiffness(const JointVector& position, const Eigen::Vector3d& g_B) const noexcept {
  const Chain& chain = solvers_->chain;
  ChainPose pose;
  forwardKinematics(chain, position, pose);
  JointMatrix K = JointMatrix::Zero(pose.joints, pose.joints);
  double mass = 0.0;
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  // mass times centre of mass, of all links so far from the tip
  for (int i = chain.links() - 1; i > 0; --i) {
    const ChainLink& link = chain.link(i);
    mass += link.body.mass;
    moment_B += link.body.mass * (pose.link(i) * link.body.p);
    if (link.joint < 0) continue;
    const auto j = static_cast<std::size_t>(link.joint);
    const Eigen::Vector3d& axis = pose.axis_B[j];
    const Eigen::Vector3d moved =
        link.prismatic ? Eigen::Vector3d(mass * axis) : Eigen::Vector3d(axis.cross(moment_B - mass * pose.p_BJ_B[j]));
    for (int k = 0; k <= link.joint; ++k) {
      const auto before = static_cast<std::size_t>(k);
      if (pose.prismatic[before]) continue;
      K(k, link.joint) = K(link.joint, k) = -pose.axis_B[before].dot(moved.cross(g_B));
    }
  }
  return K;
}

JointMatrix ChainDynamics::massMatrix(const JointVector& position) noexcept {
  Solvers& s = *solvers_;
  s.position.data = position;
  s.composite_bodies.JntToMass(s.position, s.mass);
  return s.mass.data;
}

}  // namespace hammer_loads
