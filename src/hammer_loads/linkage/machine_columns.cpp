#include "hammer_loads/linkage/machine_columns.h"

namespace hammer_loads {
namespace {

using Enters = HammerConstant::Enters;

/// The hammer with a constant so far off; nothing where there can be none.
std::optional<Mechanism> shifted(HammerParameters p, const HammerConstant& constant, double by) {
  constant.field(p) += by;
  p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  return Mechanism::make(p).value;
}

ShaftLoad loadOf(const Mechanism& mechanism, Level level, const LinkMotion& links, Gravity gravity) noexcept {
  return level == Level::kLinkage ? shaftLoadLinkage(mechanism, links, gravity)
                                  : shaftLoadRocker(mechanism, links.rocker, gravity);
}

}  // namespace

MachineColumns::MachineColumns(const Mechanism& mechanism, Level level) : mechanism_(mechanism), level_(level) {
  const HammerParameters& p = mechanism.parameters();
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    if (!(p.deviations[i] > 0.0) || constant.enters == Enters::kLearned || constant.enters == Enters::kFollows)
      continue;
    const auto other = shifted(p, constant, MachineColumn::kStep * constant.away * p.deviations[i]);
    if (other) columns_.push_back({*other, level, constant.enters, MachineColumn::kStep, constant.key});
  }
  if (level != Level::kLinkage)
    columns_.push_back(
        {mechanism, Level::kLinkage, Enters::kLoads, 1.0, level == Level::kPulse ? "level pulse" : "level rocker"});
}

MachineColumns::OnShaft MachineColumns::onShaft(CrankAngle angle, Gravity gravity) const noexcept {
  const LinkMotion links = linkMotion(mechanism_.linkage(), angle);
  const ShaftLoad here = loadOf(mechanism_, level_, links, gravity);
  OnShaft effects = OnShaft::Zero();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const MachineColumn& c = columns_[i];
    if (c.enters == Enters::kBlow) continue;
    const ShaftLoad there = loadOf(c.mechanism, c.level, c.linksAt(angle, links), gravity);
    effects.col(static_cast<Eigen::Index>(i)) << there.inertia - here.inertia,
        there.half_inertia_slope - here.half_inertia_slope, there.weight_torque - here.weight_torque;
    effects.col(static_cast<Eigen::Index>(i)) *= 1.0 / c.step;
  }
  return effects;
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
