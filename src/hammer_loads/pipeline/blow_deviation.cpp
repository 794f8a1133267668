#include "hammer_loads/pipeline/blow_deviation.h"

#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads {

void addConstants(const WrenchColumns& hammer, const HullModel& model, const CrankBlow& crank,
                  const BlowColumns& columns, RockerBlow& blow) noexcept {
  double restitution = 0.0, energy = 0.0;  // variances
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const Eigen::Index of_hammer = i - ConstantErrors::kTable;
    const bool is_hammers = of_hammer >= 0 && of_hammer < static_cast<Eigen::Index>(hammer.models().size());
    if (!is_hammers && columns.col(i).isZero(0.0)) continue;
    CrankBlow other = crank;
    other.speed += columns(0, i);
    other.factor += columns(1, i);
    other.drive_inertia *= 1.0 + columns(2, i);
    const RockerBlow there =
        measuredBlow(is_hammers ? hammer.models()[static_cast<std::size_t>(of_hammer)] : model, other);
    restitution += square(there.restitution - blow.restitution);
    energy += square(there.energy - blow.energy);
  }
  blow.restitution_common_deviation = std::sqrt(restitution);
  blow.energy_common_deviation = std::sqrt(energy);
  blow.restitution_deviation = std::hypot(blow.restitution_deviation, blow.restitution_common_deviation);
  blow.energy_deviation = std::hypot(blow.energy_deviation, blow.energy_common_deviation);
}

}  // namespace hammer_loads
