/// How far the pulse of a turn may be off, from blow to blow.
#pragma once

#include <optional>

#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/pipeline/number_error.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Errors of constants add up over the turn as the load itself; those of samples are in the momenta at its ends.
class TurnErrors {
 public:
  /// A turn begins with a blow.
  void begin(StampNs blow) noexcept;
  /// How far the momentum after that blow may be off, by samples [N s]: known some time later.
  void momentumAfterBlow(const HullWrench& deviation) noexcept { after_blow_ = deviation; }
  /// The load at a sample.
  void sample(StampNs stamp, const HullWrench& load, const HullDeviation& deviation,
              const LoadColumns& columns) noexcept;
  /// At the blow that ends the turn. before_blow: how far the momentum there may be off, by samples [N s].
  PulseErrors end(StampNs blow, const HalfSinePulse& pulse, const HullWrench& before_blow) noexcept;

 private:
  void addUpTo(StampNs stamp, const LoadColumns& columns) noexcept;

  StampNs last_{};
  LoadColumns columns_{LoadColumns::Zero()}, impulse_{LoadColumns::Zero()};
  NumberError::Columns lobe_{NumberError::Columns::Zero()};  ///< of Fz since it rose through zero
  HullWrench after_blow_;
  double peak_{};  ///< largest Fz of a sample [N]
  NumberError at_peak_;
  bool lobe_open_{}, sampled_{};
};

}  // namespace hammer_loads
