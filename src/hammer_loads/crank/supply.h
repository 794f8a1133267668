/// Law by which the drive's torque follows the crank within a revolution, and its roughness.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/crank/crank_state.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// A pump of constant flow feeds the motor through compliant oil and hoses: if the crank leads a uniform rotation, it
/// has consumed more oil than was supplied, and the torque decreases in proportion to the lead. The rest of the torque
/// is a random walk.
struct SupplyLaw {
  double stiffness{};   ///< [N m/rad]
  double mean_speed{};  ///< mean speed of the uniform rotation [rad/s]; 0: not known, nothing leads
  double unit{};        ///< unit of the stiffness' error among ConstantErrors [N m/rad]

  /// Lead of a crank that turned by an angle [rad] in dt [s] over the uniform rotation [rad].
  double lead(double turned, double dt) const noexcept { return mean_speed > 0.0 ? turned - mean_speed * dt : 0.0; }
};

/// Identification of the law: mean speed of the last turn, stiffness, and mean square of the torque.
class LearnedSupply {
 public:
  /// unit: largest stiffness [N m/rad], > 0.
  explicit LearnedSupply(double unit) noexcept : usual_(kTurns, square(unit), 1.0) { law_.unit = unit; }
  const SupplyLaw& law() const noexcept { return law_; }
  /// Notes that the time before is not known.
  void restart() noexcept {
    law_.mean_speed = 0.0;
    turn_time_ = std::numeric_limits<double>::quiet_NaN();
  }
  void pass(double dt) noexcept { turn_time_ += dt; }  ///< [s]
  /// A torque [N m] between a blow and the end of its half turn.
  void feel(double torque) noexcept { half_turn_.add(square(torque)); }
  /// Once a turn, half a turn after the blow. known: the torques since were those of the supply.
  void endTurn(const CrankPosition& at, bool known = true) noexcept {
    if (known && half_turn_.count() > 0.0) usual_.add(half_turn_.mean());
    half_turn_ = {};
    const double speed = difference(at, from_) / turn_time_;
    law_.mean_speed = speed > 0.0 ? speed : 0.0;
    from_ = at;
    turn_time_ = 0.0;
  }
  /// Mean square of those of the last turns [N2 m2]; at first the unit's.
  double usual() const noexcept { return usual_.mean(); }
  /// error: of the stiffness, as the innovations show it [unit]. By how much the stiffness changes [unit].
  double learn(double error) noexcept {
    const double change = std::clamp(law_.stiffness / law_.unit - error, 0.0, 1.0) - law_.stiffness / law_.unit;
    law_.stiffness += law_.unit * change;
    return change;
  }

 private:
  static constexpr double kTurns = 3.0;
  RunningMean<> usual_, half_turn_;
  SupplyLaw law_;
  CrankPosition from_;
  double turn_time_{std::numeric_limits<double>::quiet_NaN()};  ///< since from_ [s]; NaN: not seen from there
};

/// Adaptation of the torque's random walk, which is given for rough supplies and has little influence with exact
/// samples. Jittering stamps must be averaged over many samples; if the walk is too large, their noise is taken for
/// torque, and successive innovations change their sign too often. If it is too small, they keep their sign. Each
/// product of an innovation and the fading sum of those before it therefore adjusts the walk slightly. The given walk
/// is used while stamps are exact.
class SupplyRoughness {
 public:
  /// innovation of variance `total`, of which the stamp's jitter has the part `jitter`.
  void learn(double innovation, double total, double jitter) noexcept {
    const double now = std::clamp(innovation / std::sqrt(total), -gate::kRare, gate::kRare);
    factor_ = jitter > 0.0 ? std::clamp(factor_ * (1.0 + kGain * jitter * now * sum_), kLeast, kMost) : 1.0;
    sum_ = now + kFading * sum_;
  }
  /// Factor on the given walk [-].
  double factor() const noexcept { return factor_; }
  /// Factor on the real part of the torque's deviation. A smaller walk has a smaller deviation, while the supply is
  /// unchanged. With this factor the measured coverage is that of exact stamps.
  double deviationFactor() const noexcept { return 1.0 / std::sqrt(std::sqrt(std::min(1.0, factor_))); }

 private:
  static constexpr double kGain = 1.0 / look_back::kReadings;
  static constexpr double kFading = 0.85;              // some 7 samples are looked at
  static constexpr double kLeast = 0.25, kMost = 3.0;  // a sudden supply is still followed within some samples
  // Prior: kLeast, kMost
  double factor_{1.0}, sum_{};
};

}  // namespace hammer_loads
