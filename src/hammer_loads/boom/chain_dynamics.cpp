#include "hammer_loads/boom/chain_dynamics.h"

namespace hammer_loads {

ChainDynamics::ChainDynamics(const Chain& chain)
    : chain_(chain),
      newton_euler_(chain_.kdl(), KDL::Vector::Zero()),
      composite_bodies_(chain_.kdl(), KDL::Vector::Zero()),
      position_(chain_.kdl().getNrOfJoints()),
      velocity_(chain_.kdl().getNrOfJoints()),
      acceleration_(chain_.kdl().getNrOfJoints()),
      torque_(chain_.kdl().getNrOfJoints()),
      mass_(chain_.kdl().getNrOfJoints()),
      no_wrenches_(chain_.kdl().getNrOfSegments(), KDL::Wrench::Zero()) {}

JointVector ChainDynamics::torqueOfMotion(const JointMotion& motion) noexcept {
  if (motion.velocity.isZero(0.0) && motion.acceleration.isZero(0.0)) return JointVector::Zero(chain_.joints());
  position_.data = motion.position;
  velocity_.data = motion.velocity;
  acceleration_.data = motion.acceleration;
  newton_euler_.CartToJnt(position_, velocity_, acceleration_, no_wrenches_, torque_);
  return -torque_.data;
}

JointMatrix ChainDynamics::massMatrix(const JointVector& position) noexcept {
  position_.data = position;
  composite_bodies_.JntToMass(position_, mass_);
  return mass_.data;
}

}  // namespace hammer_loads
