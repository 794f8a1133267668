#include <cmath>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {
LoadSpread Boom::spreadTorque(const WrenchSpread& w_tip) const noexcept {
  LoadSpread torque(chain_.joints(), w_tip.count);
  for (int i = 0; i < w_tip.count; ++i) torque.col(i) = hammerTorque(w_tip.part[static_cast<std::size_t>(i)]);
  return torque;
}

void Boom::storeResponse(Eigen::Index column, const JointVector& torque, const SteelLoads& load) noexcept {
  auto rows = response_.col(column);
  Eigen::Index row = torque.size();
  rows.head(row) = torque;
  const auto append = [&](const Eigen::Vector3d& value) {
    rows.segment<3>(row) = value;
    row += 3;
  };
  for (std::size_t i = 0; i < sections().size(); ++i) append(load.section[i].force), append(load.section[i].torque);
  for (std::size_t i = 0; i < static_cast<std::size_t>(chain_.joints()); ++i)
    append(load.joint[i].force), append(load.joint[i].torque);
  for (std::size_t i = 0; i < cylinders_.size(); ++i) append(load.pins[i].rod);
}

/// Every load is linear in wrench and accelerations: the difference of two states is the load of their difference.
void Boom::findResponse() noexcept {
  if ((joints_.position - response_at_).cwiseAbs().maxCoeff() <= parameters_.vibration.refresh_angle) return;
  response_at_ = joints_.position;
  const Eigen::Index joints = chain_.joints();
  const JointVector zero = JointVector::Zero(joints);
  const Eigen::Vector3d weightless = Eigen::Vector3d::Zero();
  const Wrench none;
  SteelLoads load;
  JointMotion motion{joints_.position, zero, zero};
  for (Eigen::Index j = 0; j < joints; ++j) {
    motion.acceleration = JointVector::Unit(joints, j);
    steel_.find({pose_, motion, weightless, none, at_.data()}, load);
    storeResponse(j, zero, load);
  }
  motion.acceleration = zero;
  for (int k = 0; k < 6; ++k) {
    Wrench unit;
    (k < 3 ? unit.force : unit.torque)[k % 3] = 1.0;
    steel_.find({pose_, motion, weightless, unit, at_.data()}, load);
    storeResponse(joints + k, hammerTorque(unit), load);
  }
}

void Boom::deviations(const VibrationSpread& spread, const WrenchSpread& w_tip, bool rigid,
                      BoomDeviations& result) noexcept {
  findResponse();
  const Eigen::Index joints = chain_.joints();
  const bool vibrates = !rigid && vibration_.known();
  const JointVector vibration = vibration_.acceleration();
  variance_.setZero();
  for (int run = rigid ? VibrationSpread::kLoads : 0; run < VibrationSpread::kLoads + w_tip.count; ++run) {
    difference_.setZero();
    const auto add = [&](Eigen::Index column, double by) {
      if (by != 0.0) difference_ += by * response_.col(column);
    };
    if (vibrates && run < spread.runs()) {
      const JointVector acceleration = spread.accelerationDifference(run, vibration);
      for (Eigen::Index j = 0; j < joints; ++j) add(j, acceleration[j]);
      difference_.head(joints) -= vibration_.modes().mass.lazyProduct(acceleration);
    }
    if (run >= VibrationSpread::kLoads) {
      const Wrench& w = w_tip.part[static_cast<std::size_t>(run - VibrationSpread::kLoads)];
      for (int k = 0; k < 3; ++k) add(joints + k, w.force[k]), add(joints + 3 + k, w.torque[k]);
    }
    if (run == VibrationSpread::kSofter) {
      variance_ = variance_.cwiseMax(difference_.cwiseAbs2());  // stiffer and softer exclude each other
    } else {
      variance_ += difference_.cwiseAbs2();
    }
  }
  takeDeviations(result);
}

/// From variance_.
void Boom::takeDeviations(BoomDeviations& result) noexcept {
  Eigen::VectorXd& deviation = difference_;
  deviation = variance_.cwiseSqrt();
  Eigen::Index row = chain_.joints();
  result.torque = deviation.head(row);
  const auto next = [&] {
    row += 3;
    return deviation.segment<3>(row - 3);
  };
  for (std::size_t i = 0; i < sections().size(); ++i)
    result.section[i].force = next(), result.section[i].torque = next();
  for (std::size_t i = 0; i < static_cast<std::size_t>(chain_.joints()); ++i)
    result.joint[i].force = next(), result.joint[i].torque = next();
  result.cylinder = {};
  for (std::size_t i = 0; i < cylinders_.size(); ++i) result.cylinder[i] = next().norm();
}

std::uint16_t Boom::flags(std::size_t cylinder, const BoomLoads& loads) const noexcept {
  const Cylinder& c = cylinders_[cylinder];
  const int joint = c.joint();
  return cylinderFlags(c, at_[cylinder], loads.weight[joint] + loads.motion[joint], loads.total[joint]);
}

}  // namespace hammer_loads
