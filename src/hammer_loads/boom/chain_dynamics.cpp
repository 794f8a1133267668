#include "hammer_loads/boom/chain_dynamics.h"

#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>

#include "hammer_loads/util/inline.h"

namespace hammer_loads {
namespace {

HAMMER_LOADS_INLINE Eigen::Vector3d accelerationAt(const BodyMotion& m, const Eigen::Vector3d& r) noexcept {
  return m.acceleration + m.angular_acceleration.cross(r) + m.rate.cross(m.rate.cross(r));
}

RigidBody placed(const RigidBody& body, const Pose& X_BL) noexcept {
  const Eigen::Matrix3d R = X_BL.linear();
  return {body.mass, R * body.com, R * body.inertia * R.transpose()};
}

HAMMER_LOADS_INLINE Wrench loadOf(const RigidBody& body, const Pose& X_BL, const BodyMotion& m) noexcept {
  const Eigen::Vector3d force = -body.mass * accelerationAt(m, body.com);
  const Eigen::Vector3d moment = body.inertia * m.angular_acceleration + m.rate.cross(body.inertia * m.rate);
  return {force, (X_BL.translation() + body.com).cross(force) - moment};
}

/// Finds the motions of all links. root_acceleration: minus gravity represents the weight.
void findMotions(const Chain& chain, const ChainPose& pose, const JointMotion& motion,
                 const Eigen::Vector3d& root_acceleration, std::array<BodyMotion, kMaxLinks>& result) noexcept {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  BodyMotion now{none, none, root_acceleration};  // of the previous link, then updated to the present link
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

void placeBodies(const Chain& chain, const ChainPose& pose, PlacedBodies& result) noexcept {
  for (int i = 1; i < chain.links(); ++i)
    result[static_cast<std::size_t>(i)] = placed(chain.link(i).body, pose.link(i));
}

void findChainLoads(const Chain& chain, const ChainPose& pose, const PlacedBodies& bodies, const JointMotion& motion,
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

JointVector torqueOfMotion(const Chain& chain, const ChainPose& pose, const PlacedBodies& bodies,
                           const JointMotion& motion) noexcept {
  if (motion.velocity.isZero(0.0) && motion.acceleration.isZero(0.0)) return JointVector::Zero(chain.joints());
  ChainLoads loads;
  findChainLoads(chain, pose, bodies, motion, Eigen::Vector3d::Zero(), loads);
  return jointTorque(chain, pose, loads);
}

/// Returns second derivatives of the weight's potential. A joint turns or slides everything beyond it against gravity.
JointMatrix weightStiffness(const Chain& chain, const JointVector& position, const Eigen::Vector3d& g_B) noexcept {
  ChainPose pose;
  forwardKinematics(chain, position, pose);
  JointMatrix K = JointMatrix::Zero(pose.joints, pose.joints);
  double mass = 0.0;
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  // first moment of the links from the tip to this one
  for (int i = chain.links() - 1; i > 0; --i) {
    const ChainLink& link = chain.link(i);
    mass += link.body.mass;
    moment_B += link.body.mass * (pose.link(i) * link.body.com);
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

struct MassMatrix::Solver {
  explicit Solver(const Chain& given)
      : chain(given),
        composite_bodies(chain.kdl(), KDL::Vector::Zero()),
        position(chain.kdl().getNrOfJoints()),
        mass(chain.kdl().getNrOfJoints()) {}

  Chain chain;  ///< owns the data that KDL refers to
  KDL::ChainDynParam composite_bodies;
  KDL::JntArray position;
  KDL::JntSpaceInertiaMatrix mass;
};

MassMatrix::MassMatrix(const Chain& chain) : solver_(std::make_unique<Solver>(chain)) {}
MassMatrix::~MassMatrix() = default;
MassMatrix::MassMatrix(const MassMatrix& other) : MassMatrix(other.chain()) {}
MassMatrix& MassMatrix::operator=(const MassMatrix& other) { return *this = MassMatrix(other); }
MassMatrix::MassMatrix(MassMatrix&&) noexcept = default;
MassMatrix& MassMatrix::operator=(MassMatrix&&) noexcept = default;

const Chain& MassMatrix::chain() const noexcept { return solver_->chain; }

JointMatrix MassMatrix::at(const JointVector& position) noexcept {
  solver_->position.data = position;
  solver_->composite_bodies.JntToMass(solver_->position, solver_->mass);
  return solver_->mass.data;
}

}  // namespace hammer_loads
