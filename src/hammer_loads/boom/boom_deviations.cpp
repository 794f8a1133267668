#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {
namespace {

constexpr double kRounded = 1e-12;  // of a column: what rounding makes of zero

/// Components of a wrench within the boom's plane, and across it.
Eigen::Vector3d inPlane(const Wrench& w) noexcept { return {w.force.x(), w.force.z(), w.torque.y()}; }
Eigen::Vector3d across(const Wrench& w) noexcept { return {w.force.y(), w.torque.x(), w.torque.z()}; }
Wrench wrenchOf(const Eigen::Vector3d& in_plane, const Eigen::Vector3d& across) noexcept {
  return {{in_plane[0], across[0], in_plane[1]}, {across[1], in_plane[2], across[2]}};
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

void Boom::gatherRowsInPlane() noexcept {
  const Eigen::Index columns = response_in_plane_.cols();
  Eigen::Array<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMaxJoints + 3> least(columns);
  for (Eigen::Index c = 0; c < columns; ++c) least[c] = kRounded * response_.col(c).cwiseAbs().maxCoeff();
  in_plane_ = 0;
  response_in_plane_.setZero();
  rows_in_plane_.setConstant(static_cast<int>(response_.rows()) - 1);
  for (Eigen::Index row = 0; row < response_.rows(); ++row) {
    const auto in_plane = response_.row(row).head(columns);
    if ((in_plane.array().abs() <= least).all()) continue;
    response_in_plane_.row(in_plane_) = in_plane;
    rows_in_plane_[in_plane_++] = static_cast<int>(row);
  }
}

/// Every load is linear in wrench and accelerations: the difference of two states is the load of their difference.
void Boom::findResponse() noexcept {
  if ((steady_position_ - response_at_).cwiseAbs().maxCoeff() <= parameters_.vibration.refresh_angle) return;
  response_at_ = steady_position_;
  const Eigen::Index joints = chain_.joints();
  const JointVector zero = JointVector::Zero(joints);
  const Eigen::Vector3d weightless = Eigen::Vector3d::Zero(), none = weightless;
  SteelLoads load;
  ChainLoads links;
  JointMotion motion{joints_.position, zero, zero};
  Eigen::Index column = 0;
  for (const Cylinder& cylinder : cylinders_) {
    motion.acceleration = JointVector::Unit(joints, cylinder.joint());
    dynamics_.chainLoads(pose_, motion, weightless, links);
    steel_.find({pose_, links, {none, none}, at_.data()}, load);
    storeResponse(column++, jointTorque(chain_, pose_, links), load);
  }
  motion.acceleration = zero;
  dynamics_.chainLoads(pose_, motion, weightless, links);
  for (int k = 0; k < 6; ++k) {
    const Wrench unit = k < 3 ? wrenchOf(Eigen::Vector3d::Unit(k), none) : wrenchOf(none, Eigen::Vector3d::Unit(k - 3));
    steel_.find({pose_, links, unit, at_.data()}, load);
    storeResponse(column++, hammerTorque(unit), load);
  }
  gatherRowsInPlane();
}

Boom::Shares Boom::sharesOf(const LoadErrors& errors, std::size_t first) const noexcept {
  Shares shares = Shares::Zero(response_.cols(), kErrorsAtOnce);
  const auto held = static_cast<Eigen::Index>(cylinders_.size());
  for (std::size_t run = first; run < std::min(first + kErrorsAtOnce, errors.count); ++run) {
    auto share = shares.col(static_cast<Eigen::Index>(run - first));
    for (Eigen::Index i = 0; i < held; ++i)
      share[i] = errors.acceleration[run][cylinders_[static_cast<std::size_t>(i)].joint()];
    share.segment<3>(held) = inPlane(errors.tip[run]);
    share.tail<3>() = across(errors.tip[run]);
  }
  return shares;
}

void Boom::sumErrors(const LoadErrors& errors, bool first_two_exclude, BoomDeviations& result) noexcept {
  deviation_.setZero();
  for (std::size_t first = 0; first < errors.count; first += kErrorsAtOnce)
    addSquares(sharesOf(errors, first), first_two_exclude && first == 0);
  deviation_ = deviation_.cwiseSqrt();
  takeDeviations(result);
}

/// To deviation_.
void Boom::addSquares(const Shares& shares, bool first_two_exclude) noexcept {
  const bool in_plane = shares.bottomRows<3>().isZero(0.0);
  const Eigen::MatrixXd& response = in_plane ? response_in_plane_ : response_;
  const Eigen::Index rows = in_plane ? in_plane_ : response.rows();
  using Rows = Eigen::Array<double, kRowsAtOnce, 1>;
  for (Eigen::Index first = 0; first < rows; first += kRowsAtOnce) {
    std::array<Rows, kErrorsAtOnce> difference;
    difference.fill(Rows::Zero());
    for (Eigen::Index c = 0; c < response.cols(); ++c) {
      const Rows by = response.col(c).segment<kRowsAtOnce>(first);
      for (std::size_t run = 0; run < difference.size(); ++run)
        difference[run] += shares(c, static_cast<Eigen::Index>(run)) * by;
    }
    Rows sum = Rows::Zero();
    for (const Rows& one : difference) sum += one.square();
    if (first_two_exclude) sum -= difference[0].square().min(difference[1].square());
    for (Eigen::Index i = 0; i < kRowsAtOnce; ++i)
      deviation_[in_plane ? rows_in_plane_[first + i] : first + i] += sum[i];
  }
}

void Boom::deviations(const VibrationSpread& spread, const WrenchSpread& w_tip, bool rigid,
                      BoomDeviations& result) noexcept {
  findResponse();
  const bool vibrates = !rigid && vibration_.known();
  const JointVector of_vibration = vibration_.acceleration(), none = JointVector::Zero(of_vibration.size());
  LoadErrors errors;
  const auto add = [&](int run, const Wrench& tip) {
    const bool runs = vibrates && run < spread.runs();
    errors.add(runs ? spread.accelerationDifference(run, of_vibration) : none, tip);
  };
  for (int run = 0; run < VibrationSpread::kLoads && vibrates; ++run) add(run, {});
  for (int i = 0; i < w_tip.count; ++i) add(VibrationSpread::kLoads + i, w_tip.part[static_cast<std::size_t>(i)]);
  for (int k = 0; vibrates && spread.swings() && k < spread.modes(); ++k) errors.add(spread.accelerationOfSwing(k), {});
  // Stiffer and softer exclude each other.
  static_assert(VibrationSpread::kStiffer == 0 && VibrationSpread::kSofter == 1);
  sumErrors(errors, vibrates, result);
}

void Boom::deviations(const LoadErrors& errors, BoomDeviations& result) noexcept {
  findResponse();
  sumErrors(errors, false, result);
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
