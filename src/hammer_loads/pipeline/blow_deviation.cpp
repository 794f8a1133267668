#include "hammer_loads/pipeline/blow_deviation.h"

#include <cmath>

namespace hammer_loads {

BlowErrors ownErrors(const HullModel& model, const CrankBlow& crank, const RockerBlow& blow) noexcept {
  BlowErrors errors;
  errors.restitution.own = blow.restitution_std;
  errors.energy.own = blow.energy_std;
  const auto add = [&](const CrankBlow& other) { addDifference(blow, measuredBlow(model, other), errors); };
  CrankBlow faster = crank, rebound = crank, heavier = crank;
  faster.speed += crank.speed_std;
  rebound.factor += crank.factor_std;
  heavier.drive_inertia *= 1.0 + crank.inertia_std;
  add(faster), add(rebound), add(heavier);
  return errors;
}

void addDifference(const RockerBlow& blow, const RockerBlow& other, BlowErrors& errors) noexcept {
  errors.tool_impulse_z.own = std::hypot(errors.tool_impulse_z.own, other.tool_impulse_z - blow.tool_impulse_z);
  errors.support_impulse_z.own =
      std::hypot(errors.support_impulse_z.own, other.support_impulse_z - blow.support_impulse_z);
}

BlowErrors blowErrors(const WrenchColumns& hammer, const HullModel& model, const CrankBlow& crank,
                      const BlowColumns& columns, RockerBlow& blow) noexcept {
  BlowErrors errors = ownErrors(model, crank, blow);
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const Eigen::Index of_hammer = i - ConstantErrors::kTable;
    const bool is_hammers = of_hammer >= 0 && of_hammer < static_cast<Eigen::Index>(hammer.models().size());
    if (!is_hammers && columns.col(i).isZero(0.0)) continue;
    const auto k = static_cast<std::size_t>(of_hammer);
    const double step = is_hammers ? hammer.step(k) : 1.0;
    CrankBlow other = crank;
    other.speed += step * columns(0, i);
    other.factor += step * columns(1, i);
    other.drive_inertia *= 1.0 + step * columns(2, i);
    const RockerBlow there = measuredBlow(is_hammers ? hammer.models()[k] : model, other);
    errors.restitution.columns[i] = (there.restitution - blow.restitution) / step;
    errors.energy.columns[i] = (there.energy - blow.energy) / step;
    errors.tool_impulse_z.columns[i] = (there.tool_impulse_z - blow.tool_impulse_z) / step;
    errors.support_impulse_z.columns[i] = (there.support_impulse_z - blow.support_impulse_z) / step;
  }
  blow.restitution_std = errors.restitution.deviation();
  blow.energy_std = errors.energy.deviation();
  return errors;
}

}  // namespace hammer_loads
