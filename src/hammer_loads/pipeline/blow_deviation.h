/// Uncertainty of a measured blow, due to readings and to constants of sensor and hammer.
#pragma once

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/number_error.h"

namespace hammer_loads {

/// Errors of a CrankBlow due to independent errors of constants, one standard deviation each. Columns are in the order
/// of ConstantErrors; rows: speed [rad/s], factor [-], drive inertia (relative).
using BlowColumns = ByConstants<3, ConstantErrors::kSize, double>;

/// Returns the errors of `blow`, measuredBlow() of `crank`, one difference per constant; adds them to its deviations.
BlowErrors blowErrors(const WrenchColumns& hammer, const HullModel& model, const CrankBlow& crank,
                      const BlowColumns& columns, RockerBlow& blow) noexcept;

/// Returns the part of these errors that is due to readings.
BlowErrors ownErrors(const HullModel& model, const CrankBlow& crank, const RockerBlow& blow) noexcept;

/// Adds the difference to another possible blow to the impulse errors. It is independent of all other errors.
void addDifference(const RockerBlow& blow, const RockerBlow& other, BlowErrors& errors) noexcept;

}  // namespace hammer_loads
