#include "hammer_loads/boom/chain_dynamics.h"

#include <kdl/chaindynparam.hpp>

#include "hammer_loads/boom/body_motion.h"

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

JointVector ChainDynamics::torqueOfMotion(const ChainPose& pose, const JointMotion& motion) const noexcept {
  const Chain& chain = solvers_->chain;
  JointVector torque = JointVector::Zero(chain.joints());
  if (motion.velocity.isZero(0.0) && motion.acceleration.isZero(0.0)) return torque;
  BodyMotions links;
  findMotions(chain, pose, motion, Eigen::Vector3d::Zero(), links);
  Wrench load;
  for (int i = chain.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    load = load + bodyLoad(solvers_->bodies[here], pose.link(i), links[here]);
    const ChainLink& link = chain.link(i);
    if (link.joint < 0) continue;
    const auto j = static_cast<std::size_t>(link.joint);
    torque[link.joint] = link.prismatic ? pose.axis_B[j].dot(load.force)
                                        : pose.axis_B[j].dot(load.torque - pose.p_BJ_B[j].cross(load.force));
  }
  return torque;
}

JointMatrix ChainDynamics::massMatrix(const JointVector& position) noexcept {
  Solvers& s = *solvers_;
  s.position.data = position;
  s.composite_bodies.JntToMass(s.position, s.mass);
  return s.mass.data;
}

}  // namespace hammer_loads
