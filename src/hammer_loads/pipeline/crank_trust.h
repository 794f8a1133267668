/// Check that the crank is one that the model describes: direction of rotation, agreement of its readings.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/crank/crank_sensor.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/pipeline/refusal.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// Judges the readings of each accepted sample, not the filter's estimate, which may be wrong. While there is a refusal
/// nothing is published: no wrench, no blow, no pulse, no load cycle.
class CrankTrust {
 public:
  /// CrankFilter::strikeConsistency() beyond which readings contradict the model. With a zero 30 deg off it is 5, with
  /// a crank that turns backward 6.5, with a zero 2 deg off 2.5, on machines with an elastic rod below 2
  /// (crank_trust_test).
  static constexpr double kMost = mismatch::kContradicts;
  /// threshold of CrankFilter::consistency() for a warning that withholds nothing; a correct machine has 0.9, a zero 2
  /// deg off 2
  static constexpr double kInconsistent = mismatch::kUnexplained;

  explicit CrankTrust(const CrankSensor& sensor) noexcept : sensor_(sensor) {}

  /// reading: of the angle [rad]; strike_consistency: CrankFilter's, NaN where it is not known; step: since the sample
  /// before [s]; 0 after a restart, over which it is not known how far the crank has turned.
  void follow(double reading, double strike_consistency, double step) noexcept {
    const double turned = reading_ && step > 0.0 ? sensor_.gain() * CrankAngle::wrapToPi(reading - *reading_) : 0.0;
    reading_ = reading;
    followTurning(turned);
    if (std::isfinite(strike_consistency)) inconsistent_ = strike_consistency > kMost;
  }
  /// Notes a gap or a jump back in time, over which the crank's motion is not known.
  void begin() noexcept {
    reading_.reset();
    unpublished_ = 0;
  }
  /// Notes a forward passage of the blow. published: the estimate just before it was accurate enough to be published. A
  /// crank that rocks at the dead centre gives no information.
  void passBlow(bool published) noexcept {
    if (hasRunUp()) unpublished_ = published ? 0 : std::min(unpublished_ + 1, kUnpublished);
  }

  bool turnsBackward() const noexcept { return backward_; }
  /// Returns true if the crank has turned forward recently; a crank that only turned backward has not struck.
  bool hasRunUp() const noexcept { return forward_ > kRunUp; }
  bool isInconsistent() const noexcept { return inconsistent_ || isLost(); }
  /// Returns true if the estimate before the blow was not good enough in several successive turns.
  bool isLost() const noexcept { return unpublished_ == kUnpublished; }
  std::optional<Refusal> refusal() const noexcept {
    if (backward_) return Refusal::kBackward;
    return isInconsistent() ? std::make_optional(Refusal::kInconsistent) : std::nullopt;
  }

 private:
  /// Number of successive strokes. With a correct model one in a hundred is not accepted, after lost samples; with a
  /// zero 30 deg off on a machine with an elastic rod, or on a machine without a tool, nine of ten are not.
  static constexpr int kUnpublished = 2;
  static constexpr double kRunUp = 1.0;  ///< [rad]: more than the noise of readings, less than the motion at a blow
  /// Judges the direction of rotation. A stopping hammer that falls back on its tool turns backward by less than half a
  /// turn, since the rocker cannot pass the dead centre backward.
  void followTurning(double turned) noexcept {
    forward_ = std::max(0.0, forward_ + turned);
    back_ = std::max(0.0, back_ - turned);
    if (!backward_ && back_ > 0.5 * kTwoPi) {
      backward_ = true;
      forward_ = 0.0;
    } else if (backward_ && forward_ > 0.5 * kTwoPi) {
      backward_ = false;
      back_ = 0.0;
    }
  }
  CrankSensor sensor_;
  std::optional<double> reading_;  ///< the last one [rad]
  double forward_{}, back_{};      ///< rotation forward since the furthest point backward [rad]
  bool backward_{}, inconsistent_{};
  int unpublished_{};  ///< strokes in a row of which the estimate was not good enough to be published
};

}  // namespace hammer_loads
