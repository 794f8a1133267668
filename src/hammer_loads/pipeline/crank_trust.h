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

/// Follows the readings of each sample that the tracker has taken, not its estimate: that may have gone astray. While
/// there is a refusal nothing of the crank is published: no wrench, no blow, no pulse, no load cycle.
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
  /// Time ran back, or a gap: what the crank did meanwhile is not known.
  void begin() noexcept {
    reading_.reset();
    unbelieved_ = 0;
  }
  /// The blow was passed forward. believed: the estimate just before it was good enough to be published. A crank that
  /// rocks at the dead centre gives no information.
  void passBlow(bool believed) noexcept {
    if (hasRunUp()) unbelieved_ = believed ? 0 : std::min(unbelieved_ + 1, kUnbelieved);
  }

  bool turnsBackward() const noexcept { return backward_; }
  /// Returns true if the crank has turned forward of late: one that only ever turned backward has not struck.
  bool hasRunUp() const noexcept { return forward_ > kRunUp; }
  bool isInconsistent() const noexcept { return inconsistent_ || isLost(); }
  /// The estimate is not good enough before the blow, turn after turn.
  bool isLost() const noexcept { return unbelieved_ == kUnbelieved; }
  std::optional<Refusal> refusal() const noexcept {
    if (backward_) return Refusal::kBackward;
    return isInconsistent() ? std::make_optional(Refusal::kInconsistent) : std::nullopt;
  }

 private:
  /// Strokes in a row. Wherever the model holds one in some hundred is not accepted, after lost samples; with a zero 30
  /// deg off, on a machine with an elastic rod, or one that runs away without a tool, nine of ten are not.
  static constexpr int kUnbelieved = 2;
  static constexpr double kRunUp = 1.0;  ///< [rad]: noise of readings is less, a blow's way more
  /// A hammer that stops falls back on its tool, by less than half a turn: the rocker passes the dead centre no other
  /// way.
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
  double forward_{}, back_{};      ///< since it was furthest back, forward [rad]
  bool backward_{}, inconsistent_{};
  int unbelieved_{};  ///< strokes in a row of which the estimate was not good enough to be published
};

}  // namespace hammer_loads
