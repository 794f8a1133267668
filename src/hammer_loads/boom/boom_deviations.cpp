#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kRuns = VibrationSpread::kMaxRuns;
/// One number for each run of a spread.
using Runs = Eigen::Array<double, kRuns, 1>;
using RunColumns = Eigen::Matrix<double, kMaxJoints, kRuns>;

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

/// acceleration, torque: a column for each run; tip: of each run.
Shares sharesOf(const RunColumns& acceleration, const RunColumns& torque, const std::array<Wrench, kRuns>& tip,
                Eigen::Index joints) noexcept {
  Shares shares;
  for (Eigen::Index j = 0; j < joints; ++j) {
    shares.add(j, acceleration.row(j).transpose());
    shares.torque[static_cast<std::size_t>(j)] = torque.row(j).transpose();
  }
  for (int k = 0; k < 6; ++k) {
    Runs share = Runs::Zero();
    for (std::size_t i = 0; i < kRuns; ++i) share[static_cast<int>(i)] = (k < 3 ? tip[i].force : tip[i].torque)[k % 3];
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

template <typename Shares>
void Boom::sumRuns(const Shares& shares, bool first_two_exclude, BoomDeviations& result) noexcept {
  for (Eigen::Index row = 0; row < response_.rows(); ++row) {
    Runs difference = row < chain_.joints() ? shares.torque[static_cast<std::size_t>(row)] : Runs(Runs::Zero());
    for (std::size_t i = 0; i < shares.count; ++i) difference += response_(row, shares.column[i]) * shares.by[i];
    Runs square = difference.square();
    if (first_two_exclude) square[0] = std::max(square[0], square[1]), square[1] = 0.0;
    deviation_[row] = square.sum();
  }
  deviation_ = deviation_.cwiseSqrt();  // two at a time
  takeDeviations(result);
}

void Boom::deviations(const VibrationSpread& spread, const WrenchSpread& w_tip, bool rigid,
                      BoomDeviations& result) noexcept {
  findResponse();
  RunColumns acceleration = RunColumns::Zero(), torque = RunColumns::Zero();
  std::array<Wrench, kRuns> tip{};
  const Eigen::Index joints = chain_.joints();
  const int runs = rigid || !vibration_.known() ? 0 : std::min(spread.runs(), VibrationSpread::kLoads + w_tip.count);
  const JointVector of_vibration = vibration_.acceleration();
  for (int run = 0; run < runs; ++run) {
    const JointVector of_run = spread.accelerationDifference(run, of_vibration);
    acceleration.col(run).head(joints) = of_run;
    torque.col(run).head(joints) = -vibration_.modes().mass.lazyProduct(of_run);
  }
  for (int i = 0; i < w_tip.count; ++i)
    tip[static_cast<std::size_t>(VibrationSpread::kLoads + i)] = w_tip.part[static_cast<std::size_t>(i)];
  // Stiffer and softer exclude each other.
  static_assert(VibrationSpread::kStiffer == 0 && VibrationSpread::kSofter == 1);
  sumRuns(sharesOf(acceleration, torque, tip, joints), true, result);
}

void Boom::deviations(const MeasuredSpread& spread, BoomDeviations& result) noexcept {
  findResponse();
  RunColumns acceleration = RunColumns::Zero(), torque = RunColumns::Zero();
  const Eigen::Index joints = chain_.joints();
  for (std::size_t run = 0; run < spread.count; ++run) {
    acceleration.col(static_cast<int>(run)).head(joints) = spread.acceleration[run];
    torque.col(static_cast<int>(run)).head(joints) = -vibration_.modes().mass.lazyProduct(spread.acceleration[run]);
  }
  sumRuns(sharesOf(acceleration, torque, spread.tip, joints), false, result);
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
