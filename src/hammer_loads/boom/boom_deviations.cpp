#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kRounded = 1e-12;  // relative size below which an entry is rounding of zero
// Numerical: kRounded
/// First bending frequency of a loaded link with its joints held [rad/s]. It lies between 10 and 30 Hz. 1/kBending^2 is
/// the root mean square of the compliance over this range.
constexpr double kBending = 16.0 * kTwoPi;
// Prior: kBending
constexpr double kOfRefreshAngle = 4;  // in refresh_angle [-]; changes a standard deviation by 0.5 %
// Numerical: kOfRefreshAngle

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
  for (std::size_t i = 0; i < cylinders_.size(); ++i) append(load.pins[i].base);  // magnitude of the cylinder's force
}

/// Copies the rows of response_ that are not zero for inputs in the plane.
void Boom::arrangeResponse() noexcept {
  const Eigen::Index in_plane = response_.cols() - 3;
  const auto by = response_.leftCols(in_plane).cwiseAbs();
  Eigen::Array<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, LoadErrors::kMost> least(in_plane);
  for (Eigen::Index c = 0; c < in_plane; ++c) least[c] = kRounded * by.col(c).maxCoeff();
  in_plane_ = 0;
  for (Eigen::Index row = 0; row < response_.rows(); ++row) {
    if ((by.row(row).array() <= least).all()) continue;
    response_in_plane_.row(in_plane_) = response_.row(row).head(in_plane);
    rows_in_plane_[in_plane_++] = static_cast<int>(row);
  }
}

/// Finds the response to unit inputs. Every load is linear in wrench and accelerations, so that differences superpose.
void Boom::findResponse() noexcept {
  if ((steady_position_ - response_at_).cwiseAbs().maxCoeff() <= kOfRefreshAngle * parameters_.vibration.refresh_angle)
    return;
  response_at_ = steady_position_;
  weight_std_ = findWeightDeviation();
  bending_ = findBending();
  const Eigen::Index joints = chain_.joints();
  const JointVector zero = JointVector::Zero(joints);
  const Eigen::Vector3d weightless = Eigen::Vector3d::Zero(), none = weightless;
  SteelLoads load;
  ChainLoads links;
  JointMotion motion{joints_.position, zero, zero};
  Eigen::Index column = 0;
  for (const Cylinder& cylinder : cylinders_) {
    motion.acceleration = JointVector::Unit(joints, cylinder.joint());
    findChainLoads(chain_, pose_, bodies_, motion, weightless, links);
    steel_.find({pose_, links, {none, none}, at_.data()}, load);
    storeResponse(column++, jointTorque(chain_, pose_, links), load);
  }
  motion.acceleration = zero;
  findChainLoads(chain_, pose_, bodies_, motion, weightless, links);
  for (int k = 0; k < 6; ++k) {
    const Wrench unit = k < 3 ? wrenchOf(Eigen::Vector3d::Unit(k), none) : wrenchOf(none, Eigen::Vector3d::Unit(k - 3));
    steel_.find({pose_, links, unit, at_.data()}, load);
    storeResponse(column++, hammerTorque(unit), load);
  }
  arrangeResponse();
}

void Boom::deviations(const VibrationSpread& spread, const WrenchSpread& w_tip, bool rigid,
                      BoomDeviations& result) noexcept {
  const bool vibrates = !rigid && vibration_.known();
  const JointVector of_vibration = vibration_.acceleration(), none = JointVector::Zero(of_vibration.size());
  LoadErrors errors(cylinders_);
  const auto difference = [&](int run) { return spread.accelerationDifference(run, of_vibration); };
  if (vibrates) {
    errors.addLarger(difference(VibrationSpread::kStiffer), difference(VibrationSpread::kSofter));
    errors.add(difference(VibrationSpread::kDamped), {});
  }
  for (int i = 0; i < w_tip.count; ++i) {
    const int run = VibrationSpread::kLoads + i;
    errors.add(vibrates && run < spread.runs() ? difference(run) : none, w_tip.part[static_cast<std::size_t>(i)]);
  }
  for (int k = 0; vibrates && spread.startsUnknown() && k < spread.modes(); ++k)
    errors.add(spread.accelerationOfSwing(k), {});
  deviations(errors, result);
}

void Boom::deviations(const LoadErrors& errors, BoomDeviations& result) noexcept {
  findResponse();
  if (errors.isAcross()) {
    errors.findVariances(response_, deviation_);
    deviation_ = deviation_.cwiseSqrt();
  } else {
    auto variance = variance_.head(in_plane_);
    errors.findVariances(response_in_plane_.topRows(in_plane_), variance);
    deviation_.setZero();
    for (Eigen::Index i = 0; i < in_plane_; ++i) deviation_[rows_in_plane_[i]] = std::sqrt(variance[i]);
  }
  computeDeviations(result);
}

void Boom::deviations(const Eigen::Matrix3d& tip, BoomDeviations& result) noexcept {
  findResponse();
  deviation_.setZero();
  const auto first = static_cast<Eigen::Index>(cylinders_.size());  // before it: accelerations
  for (Eigen::Index i = 0; i < in_plane_; ++i)
    deviation_[rows_in_plane_[i]] = response_in_plane_.row(i).segment<3>(first).lazyProduct(tip).norm();
  computeDeviations(result);
}

/// Returns the contribution of one link to the mass matrix [kg m2].
double Boom::ownInertia(int link, int joint, int other) const noexcept {
  const auto j = static_cast<std::size_t>(joint), k = static_cast<std::size_t>(other);
  if (pose_.prismatic[j] || pose_.prismatic[k]) return 0.0;
  const RigidBody& body = bodies_[static_cast<std::size_t>(link)];
  const Eigen::Vector3d com = pose_.link(link).translation() + body.com, &a = pose_.axis_B[j], &b = pose_.axis_B[k];
  return a.dot(body.inertia * b) + body.mass * a.cross(com - pose_.p_BJ_B[j]).dot(b.cross(com - pose_.p_BJ_B[k]));
}

/// Returns the effect of bending. A link has a hinge in its middle of compliance 1/(kBending^2 J), with the inertia J
/// beyond it. Everything beyond rotates by half of the hinge angle at each of its two joints. The link's own mass does
/// not rotate with the first.
JointMatrix Boom::findBending() const noexcept {
  const BoomModes& modes = vibration_.modes();
  JointMatrix by_moment = JointMatrix::Zero(chain_.joints(), std::max(0, modes.count - 1));
  for (int i = 0; i + 1 < modes.count; ++i) {
    const int one = modes.joint[static_cast<std::size_t>(i)], next = modes.joint[static_cast<std::size_t>(i + 1)];
    const double turns = 0.25 * (modes.mass(one, one) + 2.0 * modes.mass(one, next) + modes.mass(next, next));
    for (int j = 0; j <= one; ++j)
      for (int link = chain_.linkBeyond(one); link < chain_.linkBeyond(next); ++link)
        by_moment(j, i) += 0.5 * ownInertia(link, j, one) / (square(kBending) * turns);
  }
  return by_moment;
}

JointVector Boom::bendingDeviation() const noexcept {
  const BoomModes& modes = vibration_.modes();
  JointVector variance = JointVector::Zero(chain_.joints());
  const JointVector acceleration = vibration_.acceleration();
  for (int i = 0; i < bending_.cols() && i + 1 < modes.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double moment = 0.5 * (modes.stiffness[i] * acceleration[modes.joint[k]] +
                                 modes.stiffness[i + 1] * acceleration[modes.joint[k + 1]]);
    variance += (bending_.col(i) * moment).cwiseAbs2();
  }
  return variance.cwiseSqrt();
}

/// Adds independent errors of the links. The first moment of an identified link includes all that it carries and turns
/// with this link alone. Links beyond the next joint are therefore not counted again.
JointVector Boom::findWeightDeviation() const noexcept {
  JointVector variance = JointVector::Zero(chain_.joints());
  for (int i = 1; i < chain_.links(); ++i) {
    const RigidBody& body = chain_.link(i).body;
    const Pose& X_BL = pose_.link(i);
    const WeighedLink* weighed = findLink(parameters_.chain.weighed, chain_.link(i).name);
    const Eigen::Vector3d x_B = X_BL.linear().col(0), z_B = X_BL.linear().col(2);
    for (int j = 0; j < chain_.joints() && chain_.linkBeyond(j) <= i; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      if (pose_.prismatic[joint]) {
        if (!weighed) variance[j] += square(parameters_.link_mass_std * body.mass * pose_.axis_B[joint].dot(g_B_));
        continue;
      }
      const auto of = [&](const Eigen::Vector3d& moment_B) { return pose_.axis_B[joint].dot(moment_B.cross(g_B_)); };
      if (weighed) {
        variance[j] += square(weighed->moment_x_std * of(x_B)) + square(weighed->moment_z_std * of(z_B));
        continue;
      }
      variance[j] += square(parameters_.link_mass_std * of(body.mass * (X_BL * body.com - pose_.p_BJ_B[joint]))) +
                     square(parameters_.link_com_std * body.mass) * (square(of(x_B)) + square(of(z_B)));
    }
  }
  for (const Cylinder& cylinder : cylinders_) {
    const double zero = cylinder.parameters().joint_zero_std;
    if (zero == 0.0) continue;
    const int k = cylinder.joint();
    for (int j = 0; j < chain_.joints(); ++j) {  // masses beyond both joints rotate
      const PointMass beyond = massFrom(chain_, pose_, chain_.linkBeyond(std::max(j, k)));
      const auto at = static_cast<std::size_t>(std::max(j, k));
      const Eigen::Vector3d moved = pose_.axis_B[static_cast<std::size_t>(k)].cross(beyond.p - pose_.p_BJ_B[at]);
      variance[j] += square(zero * pose_.axis_B[static_cast<std::size_t>(j)].dot((beyond.mass * moved).cross(g_B_)));
    }
  }
  return variance.cwiseSqrt();
}

/// Fills result from deviation_.
void Boom::computeDeviations(BoomDeviations& result) const noexcept {
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
