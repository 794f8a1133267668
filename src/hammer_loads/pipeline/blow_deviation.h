/// How far a measured blow may be off, by constants of sensor and hammer.
#pragma once

#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/hammer/wrench_columns.h"

namespace hammer_loads {

/// What independent errors of constants make of a CrankBlow, one standard deviation each, in the order of
/// ConstantErrors: rows speed [rad/s], factor [-], drive inertia (relative).
using BlowColumns = Eigen::Matrix<double, 3, ConstantErrors::kSize>;

/// Adds them to the deviations of a blow: each column by a difference at its own size.
void addConstants(const WrenchColumns& hammer, const HullModel& model, const CrankBlow& crank,
                  const BlowColumns& columns, RockerBlow& blow) noexcept;

}  // namespace hammer_loads
