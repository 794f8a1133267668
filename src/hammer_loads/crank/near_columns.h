/// Columns on the shaft at the place where they were last needed, for the places beside it.
#pragma once

#include <cmath>
#include <limits>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// A step begins where the last one ended, but for what its reading has corrected, and the deviation of its
/// acceleration is asked there: one evaluation of the hammer's columns serves all three.
class NearColumns {
 public:
  /// Of the place itself or of one beside it on the same branch.
  MachineColumns::OnShaft at(const ShaftModel& model, CrankAngle angle) const noexcept {
    return serves(angle) ? on_shaft_ : model.columns(angle);
  }
  /// The same, and stands there from now on.
  const MachineColumns::OnShaft& moveTo(const ShaftModel& model, CrankAngle angle) noexcept {
    if (!serves(angle)) {
      on_shaft_ = model.columns(angle);
      angle_ = angle;
    }
    return on_shaft_;
  }

 private:
  /// [rad], within which a column changes by a hundredth of its largest value.
  static constexpr double kBeside = 1e-3;
  // Guard: NearColumns.AreThoseOfTheirPlaceToAHundredthOfTheLargest of kBeside
  bool serves(CrankAngle angle) const noexcept {
    return angle.side == angle_.side && std::abs(angle.offset - angle_.offset) < kBeside;
  }

  CrankAngle angle_{std::numeric_limits<double>::quiet_NaN()};
  MachineColumns::OnShaft on_shaft_{MachineColumns::OnShaft::Zero()};
};

}  // namespace hammer_loads
