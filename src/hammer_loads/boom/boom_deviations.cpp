#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {
namespace {

/// One number for each run of a spread.
using Runs = Eigen::Array<double, VibrationSpread::kMaxRuns, 1>;

/// What makes the runs differ from the loads: how much each column of the response counts, and joint torques beside.
struct Shares {
  std::size_t count{};  ///< of columns that any run has
  std::array<Eigen::Index, kMaxJoints + 6> column;
  std::array<Runs, kMaxJoints + 6> by;
  std::array<Runs, kMaxJoints> torque;  ///< by the modes' mass matrix

  void add(Eigen::Index of_column, const Runs& share) noexcept {
    if (!(share != 0.0).any()) return;
    column[count] = of_column;
    by[count++] = share;
  }
};

Shares sharesOf(const VibrationSpread& spread, const Vibration& vibration, const WrenchSpread& w_tip, bool rigid,
                Eigen::Index joints) noexcept {
  using Columns = Eigen::Matrix<double, kMaxJoints, VibrationSpread::kMaxRuns>;
  Columns acceleration = Columns::Zero(), torque = Columns::Zero();
  const int runs = rigid || !vibration.known() ? 0 : std::min(spread.runs(), VibrationSpread::kLoads + w_tip.count);
  const JointVector of_vibration = vibration.acceleration();
  for (int run = 0; run < runs; ++run) {
    const JointVector of_run = spread.accelerationDifference(run, of_vibration);
    acceleration.col(run).head(joints) = of_run;
    torque.col(run).head(joints) = -vibration.modes().mass.lazyProduct(of_run);
  }
  Shares shares;
  for (Eigen::Index j = 0; j < joints; ++j) {
    shares.add(j, acceleration.row(j).transpose());
    shares.torque[static_cast<std::size_t>(j)] = torque.row(j).transpose();
  }
  for (int k = 0; k < 6; ++k) {
    Runs share = Runs::Zero();
    for (int i = 0; i < w_tip.count; ++i) {
      const Wrench& w = w_tip.part[static_cast<std::size_t>(i)];
      share[VibrationSpread::kLoads + i] = (k < 3 ? w.force : w.torque)[k % 3];
    }
    shares.add(joints + k, share);
  }
  return shares;
}

}  // namespace

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
  const Shares shares = sharesOf(spread, vibration_, w_tip, rigid, chain_.joints());
  for (Eigen::Index row = 0; row < response_.rows(); ++row) {
    Runs difference = row < chain_.joints() ? shares.torque[static_cast<std::size_t>(row)] : Runs(Runs::Zero());
    for (std::size_t i = 0; i < shares.count; ++i) difference += response_(row, shares.column[i]) * shares.by[i];
    const Runs square = difference.square();
    // Stiffer and softer exclude each other.
    deviation_[row] = std::max(square[VibrationSpread::kStiffer], square[VibrationSpread::kSofter]);
    for (int run = VibrationSpread::kDamped; run < VibrationSpread::kMaxRuns; ++run) deviation_[row] += square[run];
  }
  deviation_ = deviation_.cwiseSqrt();  // two at a time
  takeDeviations(result);
}

/// From deviation_.
void Boom::takeDeviations(BoomDeviations& result) const noexcept {
  Eigen::Index row = chain_.joints();
  result.torque = deviation_.head(row);
  const auto next = [&] {
    row += 3;
    return deviation_.segment<3>(row - 3);
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
