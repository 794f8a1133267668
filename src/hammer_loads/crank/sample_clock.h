/// Time between crank samples that are taken at equal intervals.
#pragma once

namespace hammer_loads {

/// Knowledge of the time before a sample that is one of equal intervals.
struct SampleClock {
  double interval{};        ///< [s]; 0 if not known or not constant
  double suspected_loss{};  ///< time by which the sample's stamp is late, in whole intervals [s]; it may only be late
  bool may_have_lost{};     ///< the stamp allows for lost samples before it
};

}  // namespace hammer_loads
