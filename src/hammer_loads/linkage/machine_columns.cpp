#include "hammer_loads/linkage/machine_columns.h"

namespace hammer_loads {
namespace {

using Enters = HammerConstant::Enters;

/// Returns the hammer with the rod that closes the linkage; empty if no such hammer can exist.
std::optional<Mechanism> closed(HammerParameters p) {
  p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  return Mechanism::make(p).value;
}

/// Returns the hammer with one constant changed by `by`.
std::optional<Mechanism> shifted(HammerParameters p, const HammerConstant& constant, double by) {
  constant.field(p) += by;
  return closed(p);
}

ShaftLoad loadOf(const Mechanism& mechanism, Level level, const LinkMotion& links, Gravity gravity) noexcept {
  return level == Level::kLinkage ? shaftLoadLinkage(mechanism, links, gravity)
                                  : shaftLoadRocker(mechanism, links.rocker, gravity);
}

/// Derivatives of the inertia, half its slope and the weight's torque by the links' masses.
LinkMasses::Effect effectOnShaft(const LinkMotion& l, Gravity gravity) noexcept {
  using M = LinkMasses;
  const double u = l.rocker.u, v = l.v, bend = v * (v - 1.0);
  M::Effect by = M::Effect::Zero();
  const auto weight = [&](int i, Planar rate) { by(2, i) = gravity.z * rate.re + gravity.x * rate.im; };
  weight(M::kCrank, l.phi), weight(M::kCrank + 1, turned(l.phi));
  weight(M::kRod, v * l.beta), weight(M::kRod + 1, turned(v * l.beta));
  weight(M::kRocker, u * l.psi);
  by.col(M::kCrankInertia) << 1.0, 0.0, 0.0;
  by.col(M::kRodInertia) << v * v, v * l.dv, 0.0;
  by.col(M::kRockerInertia) << u * u, u * l.rocker.du, 0.0;
  by.col(M::kCoupling) << 2.0 * v * l.delta.re, l.dv * l.delta.re - bend * l.delta.im, 0.0;
  by.col(M::kCoupling + 1) << -2.0 * v * l.delta.im, -l.dv * l.delta.im - bend * l.delta.re, 0.0;
  return by;
}

}  // namespace

MachineColumns::MachineColumns(const Mechanism& mechanism, Level level) : mechanism_(mechanism), level_(level) {
  const HammerParameters& p = mechanism.parameters();
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    if (!(p.deviations[i] > 0.0) || constant.enters == Enters::kLearned || constant.enters == Enters::kFollows)
      continue;
    const auto other = shifted(p, constant, MachineColumn::kStep * constant.away * p.deviations[i]);
    if (other) add(*other, level, constant.enters, MachineColumn::kStep, constant.key);
  }
  if (level != Level::kLinkage)
    add(mechanism, Level::kLinkage, Enters::kLoads, 1.0, level == Level::kPulse ? "level pulse" : "level rocker");
}

void MachineColumns::add(const Mechanism& other, Level level, Enters enters, double step, const std::string& name) {
  const bool of_masses = enters == Enters::kLoads && haveLikeMotion(other, mechanism_);
  const LinkMasses::Vector change = (LinkMasses::of(other, level) - LinkMasses::of(mechanism_, level_)) / step;
  const auto column = static_cast<Eigen::Index>(columns_.size());
  for (Eigen::Index i = 0; of_masses && i < change.size(); ++i)
    if (change[i] != 0.0) parts_.push_back({column, i, change[i]});
  columns_.push_back({other, level, enters, step, name, of_masses});
}

std::optional<Mechanism> MachineColumns::hammerOff(const Eigen::VectorXd& errors) const {
  HammerParameters p = mechanism_.parameters();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (const auto k = indexOfConstant(columns_[i].name))
      kHammerConstants[*k].field(p) +=
          kHammerConstants[*k].away * p.deviations[*k] * errors[static_cast<Eigen::Index>(i)];
  }
  return closed(p);
}

MachineColumns::OnShaft MachineColumns::onShaft(CrankAngle angle, Gravity gravity) const noexcept {
  const LinkMotion links = linkMotion(mechanism_.linkage(), angle);
  const ShaftLoad here = loadOf(mechanism_, level_, links, gravity);
  OnShaft effects = byMasses(effectOnShaft(links, gravity));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const MachineColumn& c = columns_[i];
    if (c.enters == Enters::kBlow || c.of_masses) continue;
    const ShaftLoad there = loadOf(c.mechanism, c.level, c.linksAt(angle, links), gravity);
    const double by = 1.0 / c.step;
    const Eigen::Vector3d change(there.inertia - here.inertia, there.half_inertia_slope - here.half_inertia_slope,
                                 there.weight_torque - here.weight_torque);
    effects.col(static_cast<Eigen::Index>(i)) = (by * change).cast<float>();
  }
  return effects;
}

ShaftTable MachineColumns::shaftTable() const {
  return ShaftTable([&](CrankAngle angle) {
    ShaftTable::Point point;
    point << onShaft(angle, {1.0, 0.0}), onShaft(angle, {0.0, 1.0}).row(2);
    return point;
  });
}

bool isPossible(const HammerParameters& parameters, std::size_t constant) {
  const HammerConstant& c = kHammerConstants[constant];
  return shifted(parameters, c, c.away * parameters.deviations[constant]).has_value();
}

std::shared_ptr<const MachineColumns> machineColumns(const Mechanism& mechanism, Level level) {
  auto columns = std::make_shared<const MachineColumns>(mechanism, level);
  return columns->columns().empty() ? nullptr : columns;
}

}  // namespace hammer_loads
