#include <cmath>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {
namespace {

void addSquares(const Wrench& w, double weight, Wrench& sum) noexcept {
  sum.force += weight * w.force.cwiseAbs2();
  sum.torque += weight * w.torque.cwiseAbs2();
}

void takeRoots(Wrench& w) noexcept {
  w.force = w.force.cwiseSqrt();
  w.torque = w.torque.cwiseSqrt();
}

}  // namespace

LoadSpread Boom::spreadTorque(const WrenchSpread& w_tip) const noexcept {
  LoadSpread torque(chain_.joints(), w_tip.count);
  for (int i = 0; i < w_tip.count; ++i) torque.col(i) = hammerTorque(w_tip.part[static_cast<std::size_t>(i)]);
  return torque;
}

/// Every load is linear in wrench and accelerations: the difference of two states is the load of their difference.
void Boom::deviations(const VibrationSpread& spread, const WrenchSpread& w_tip, bool rigid,
                      BoomDeviations& result) const noexcept {
  const JointVector zero = JointVector::Zero(chain_.joints());
  const Eigen::Vector3d weightless = Eigen::Vector3d::Zero();
  result.torque = zero;
  result.cylinder = {};
  const std::size_t sections = this->sections().size(), joints = static_cast<std::size_t>(chain_.joints());
  for (std::size_t i = 0; i < sections; ++i) result.section[i] = {};
  for (std::size_t i = 0; i < joints; ++i) result.joint[i] = {};
  SteelLoads load;
  for (int run = rigid ? VibrationSpread::kLoads : 0; run < VibrationSpread::kLoads + w_tip.count; ++run) {
    const double weight = VibrationSpread::weight(run);
    const Wrench w =
        run < VibrationSpread::kLoads ? Wrench{} : w_tip.part[static_cast<std::size_t>(run - VibrationSpread::kLoads)];
    const bool follows = !rigid && vibration_.known() && run < spread.runs();
    const JointMotion motion{joints_.position, zero, follows ? spread.accelerationDifference(run, vibration_) : zero};
    steel_.find({pose_, motion, weightless, w}, load);
    JointVector torque = hammerTorque(w);
    if (follows) torque -= vibration_.modes().mass * motion.acceleration;
    result.torque += weight * torque.cwiseAbs2();
    for (std::size_t i = 0; i < sections; ++i) addSquares(load.section[i], weight, result.section[i]);
    for (std::size_t i = 0; i < joints; ++i) addSquares(load.joint[i], weight, result.joint[i]);
    for (std::size_t i = 0; i < cylinders_.size(); ++i) result.cylinder[i] += weight * load.pins[i].rod.squaredNorm();
  }
  result.torque = result.torque.cwiseSqrt();
  for (std::size_t i = 0; i < sections; ++i) takeRoots(result.section[i]);
  for (std::size_t i = 0; i < joints; ++i) takeRoots(result.joint[i]);
  for (std::size_t i = 0; i < cylinders_.size(); ++i) result.cylinder[i] = std::sqrt(result.cylinder[i]);
}

std::uint16_t Boom::flags(std::size_t cylinder, const BoomLoads& loads) const noexcept {
  const Cylinder& c = cylinders_[cylinder];
  const int joint = c.joint();
  return cylinderFlags(c, c.at(joints_.position[joint]), loads.weight[joint] + loads.motion[joint], loads.total[joint]);
}

}  // namespace hammer_loads
