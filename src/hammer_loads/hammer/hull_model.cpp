#include "hammer_loads/hammer/hull_model.h"

#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

HullModel::HullModel(const Mechanism& mechanism, Level level) : mechanism_(&mechanism), level_(rigid(level)) {
  if (level != Level::kPulse) return;
  const HalfSinePulse nominal = pulseAtConstantSpeed(mechanism, Level::kRocker, 1.0, {}).pulse;
  if (!(nominal.frequency > 0.0)) return;
  pulse_ = {nominal.amplitude, nominal.frequency, kPi / nominal.frequency};
}

}  // namespace hammer_loads
