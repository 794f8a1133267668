#include "hammer_loads/boom/chain_dynamics.h"

#include <kdl/chaindynparam.hpp>

namespace hammer_loads {

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
