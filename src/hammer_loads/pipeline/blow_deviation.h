/// Uncertainty of a measured blow, by readings and by constants of sensor and hammer.
#pragma once

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/number_error.h"

namespace hammer_loads {

/// Errors of a CrankBlow by independent errors of constants, one standard deviation each, in the order of
/// ConstantErrors: rows speed [rad/s], factor [-], drive inertia (relative).
using BlowColumns = ByConstants<3, ConstantErrors::kSize>;

/// blow: measuredBlow() of `crank`, whose deviations get the part of constants. Each cause by a difference.
BlowErrors blowErrors(const WrenchColumns& hammer, const HullModel& model, const CrankBlow& crank,
                      const BlowColumns& columns, RockerBlow& blow) noexcept;

/// Part of these deviations by readings.
BlowErrors ownErrors(const HullModel& model, const CrankBlow& crank, const RockerBlow& blow) noexcept;

/// Adds to the impulses the difference to another blow that cannot be ruled out; it is independent of all else.
void addDoubt(const RockerBlow& blow, const RockerBlow& other, BlowErrors& errors) noexcept;

}  // namespace hammer_loads
