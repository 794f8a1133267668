#include "hammer_loads/boom/chain_dynamics.h"

#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

namespace hammer_loads {

struct ChainDynamics::Solvers {
  explicit Solvers(const Chain& given)
      : chain(given),
        newton_euler(chain.kdl(), KDL::Vector::Zero()),
        composite_bodies(chain.kdl(), KDL::Vector::Zero()),
        position(chain.kdl().getNrOfJoints()),
        velocity(chain.kdl().getNrOfJoints()),
        acceleration(chain.kdl().getNrOfJoints()),
        torque(chain.kdl().getNrOfJoints()),
        mass(chain.kdl().getNrOfJoints()),
        no_wrenches(chain.kdl().getNrOfSegments(), KDL::Wrench::Zero()) {}

  Chain chain;  ///< keeps alive what the solvers refer to
  KDL::ChainIdSolver_RNE newton_euler;
  KDL::ChainDynParam composite_bodies;
  KDL::JntArray position, velocity, acceleration, torque;
  KDL::JntSpaceInertiaMatrix mass;
  KDL::Wrenches no_wrenches;
};

ChainDynamics::ChainDynamics(const Chain& chain) : solvers_(std::make_unique<Solvers>(chain)) {}
ChainDynamics::~ChainDynamics() = default;
ChainDynamics::ChainDynamics(const ChainDynamics& other) : ChainDynamics(other.solvers_->chain) {}
ChainDynamics& ChainDynamics::operator=(const ChainDynamics& other) { return *this = ChainDynamics(other); }
ChainDynamics::ChainDynamics(ChainDynamics&&) noexcept = default;
ChainDynamics& ChainDynamics::operator=(ChainDynamics&&) noexcept = default;

JointVector ChainDynamics::torqueOfMotion(const JointMotion& motion) noexcept {
  Solvers& s = *solvers_;
  if (motion.velocity.isZero(0.0) && motion.acceleration.isZero(0.0)) return JointVector::Zero(s.chain.joints());
  s.position.data = motion.position;
  s.velocity.data = motion.velocity;
  s.acceleration.data = motion.acceleration;
  s.newton_euler.CartToJnt(s.position, s.velocity, s.acceleration, s.no_wrenches, s.torque);
  return -s.torque.data;
}

JointMatrix ChainDynamics::massMatrix(const JointVector& position) noexcept {
  Solvers& s = *solvers_;
  s.position.data = position;
  s.composite_bodies.JntToMass(s.position, s.mass);
  return s.mass.data;
}

}  // namespace hammer_loads
