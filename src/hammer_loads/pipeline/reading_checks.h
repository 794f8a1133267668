/// Checks common to the readings of all sensors: overdue, simultaneous, jumping.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Shortest interval between two readings of any sensor of a machine [s].
constexpr double kSameInstant = 1e-4;

/// Returns true if two consecutive stamps of one sensor are too close for a rate: their difference comes from the bus.
inline bool cameTogether(StampNs before, StampNs after) noexcept { return seconds(after - before) < kSameInstant; }

/// Returns the time since a second reading was due [s]; negative before that. since: time since the last reading;
/// interval: time between the last two.
inline double overdue(double since, double interval) noexcept {
  constexpr double kIntervals = 2.0;
  return since - kIntervals * interval;
}

/// Returns the part of the last reading that is no longer valid, 0 to 1. overdue: as above [s].
inline double forgottenPart(double overdue) noexcept {
  return overdue > 0.0 ? -std::expm1(-overdue / look_back::kHeld) : 0.0;
}

/// Refuses a reading that differs from the last one by more than twelve times the root mean square of some hundred such
/// differences. A second one in a row is accepted, so that a true jump is one reading late. On a hammer at work, also
/// on rock, differences reach nine times the root mean square (IMU of 1 kHz to 100 Hz, pressures of 500 to 200 Hz).
class JumpGuard {
 public:
  /// least: largest jump that is always accepted.
  explicit JumpGuard(double least) noexcept : least_(least) {}

  /// Returns true if a reading is accepted. jump: from the last accepted reading, >= 0.
  bool accepts(double jump) noexcept {
    const double limit = std::max(least_, kFactor * std::sqrt(square_));
    const bool far = jump > limit;
    square_ += kShare * (square(std::min(jump, limit)) - square_);
    refused_ = far && !refused_;
    return !refused_;
  }

 private:
  static constexpr double kFactor = 12.0, kShare = 0.01;
  // Limit: kFactor, kShare

  double least_;
  double square_{};  ///< mean of the jumps' squares
  bool refused_{};   ///< the last reading was refused
};

}  // namespace hammer_loads
