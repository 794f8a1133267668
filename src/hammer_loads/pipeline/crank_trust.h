/// Whether the crank is one that the model describes: which way it turns, where it is slow, whether its readings agree.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/crank/crank_sensor.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/pipeline/refusal.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// Follows the readings of each sample that the tracker has taken, not its estimate: that may have gone astray. While
/// there is a refusal nothing of the crank is published: no wrench, no blow, no pulse, no load cycle.
class CrankTrust {
 public:
  /// CrankTracker::strikeConsistency() beyond which readings contradict the model. With a zero 30 deg off it is 5, with
  /// a crank that turns backward 6.5, with a zero 2 deg off 2.5, on machines whose rod gives below 2
  /// (crank_trust_test).
  static constexpr double kMost = mismatch::kContradicts;
  /// Of CrankTracker::consistency(), what is said, but not withheld; a clean machine has 0.9, a zero 2 deg off 2.
  static constexpr double kInconsistent = mismatch::kUnexplained;
  static constexpr double kSlowestKnown = 0.2;  ///< slowBehind() of a right zero is less [rad] (crank_trust_test)
  // Guard: CrankTrust.AZeroFarOffIsWithheldOnAMachineWhoseRodGives of kSlowestKnown

  explicit CrankTrust(const CrankSensor& sensor) noexcept : sensor_(sensor) {}

  /// reading: of the angle [rad]; strike_consistency: CrankTracker's, NaN where it is not known; step: since the sample
  /// before [s]; 0 after a restart, over which it is not known how far the crank has turned; struck: the last blow met
  /// a tool, else the crank is slow elsewhere.
  void follow(double reading, double strike_consistency, double step, bool struck = true) noexcept {
    const double turned = reading_ && step > 0.0 ? sensor_.gain() * CrankAngle::wrapToPi(reading - *reading_) : 0.0;
    reading_ = reading;
    followTurning(turned);
    if (struck) followSpeed(sensor_.angle(reading), turned, step);
    if (std::isfinite(strike_consistency)) inconsistent_ = strike_consistency > kMost;
    contradicted_ = contradicted_ || inconsistent_ || isLost();
  }
  /// Time ran back, or a gap: what the crank did meanwhile is not known.
  void begin() noexcept {
    reading_.reset();
    unbelieved_ = 0;
    contradicted_ = false;
  }
  /// The blow was passed forward. believed: the estimate just before it was good enough to be published. A crank that
  /// rocks at the dead centre says nothing.
  void passBlow(bool believed) noexcept {
    if (hasRunUp()) unbelieved_ = believed ? 0 : std::min(unbelieved_ + 1, kUnbelieved);
  }

  /// How far the crank is slowest behind the place where such cranks are, by the first harmonic of its speed over the
  /// angle [rad]. Nothing before some turns, or of one that turns evenly.
  std::optional<double> slowBehind() const noexcept {
    const double swing = 2.0 * std::hypot(along_.mean(), across_.mean());
    if (!along_.isFull() || !(swing > kLeastSwing * std::abs(mean_.mean()))) return std::nullopt;
    return CrankAngle::wrapToPi(std::atan2(-across_.mean(), -along_.mean()) - kSlowest);
  }
  bool turnsBackward() const noexcept { return backward_; }
  /// It has turned forward of late: one that only ever turned backward has not struck.
  bool hasRunUp() const noexcept { return forward_ > kRunUp; }
  /// Where the zero is far off it stays so: a stroke that agrees is chance.
  bool isInconsistent() const noexcept { return inconsistent_ || isLost() || (contradicted_ && zeroFarOff()); }
  /// slowBehind() where no right zero makes that [rad].
  std::optional<double> zeroFarOff() const noexcept {
    const std::optional<double> behind = slowBehind();
    return behind && std::abs(*behind) > kSlowestKnown ? behind : std::nullopt;
  }
  /// The estimate is not good enough before the blow, turn after turn.
  bool isLost() const noexcept { return unbelieved_ == kUnbelieved; }
  std::optional<Refusal> refusal() const noexcept {
    if (backward_) return Refusal::kBackward;
    return isInconsistent() ? std::make_optional(Refusal::kInconsistent) : std::nullopt;
  }

 private:
  /// Strokes in a row. Wherever the model holds one in some hundred is not believed, after lost samples; with a zero
  /// 30 deg off, on a machine whose rod gives, or one that runs away without a tool, nine of ten are not.
  static constexpr int kUnbelieved = 2;
  // Guard: PoseAndTrust.TwoStrokesInARowThatAreNotBelieved of kUnbelieved
  static constexpr double kRunUp = 1.0;  ///< [rad]: noise of readings is less, a blow's way more
  // Guard: PoseAndTrust.ACrankHasRunUpAfterARadian of kRunUp
  static constexpr double kTurns = look_back::kTurnsToKnow;  ///< over which it is looked where the crank is slow
  /// [rad] after the blow, once five turns are like each other: 0.79 to 0.89 (medians) on the machines of the
  /// recordings that their drive keeps at work, whatever their rod, rock and boom, 0.75 to 0.93 on 58 drawn ones, half
  /// of them with a rod that gives.
  static constexpr double kSlowest = 0.83;
  // Guard: PoseAndTrust.ACrankIsSlowWhereSuchAreWithinFiveTurns of kSlowest
  static constexpr double kLeastSwing = 0.03;  ///< of the mean speed: a tenth of what such machines have
  // Guard: PoseAndTrust.ACrankThatTurnsEvenlyIsSlowNowhere of kLeastSwing
  static constexpr double kWindow = 0.3;  ///< [rad] over which a speed is taken: jitter of stamps counts little
  // Numerical: kWindow

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
  void followSpeed(double angle, double turned, double step) noexcept {
    window_turned_ += turned;
    window_time_ += step;
    if (std::abs(window_turned_) < kWindow) return;
    const double speed = window_turned_ / window_time_, middle = angle - 0.5 * window_turned_;
    if (window_time_ > 0.0) {
      const double weight = std::abs(window_turned_);
      mean_.add(speed, weight);  // a part of a turn is no harmonic of it
      along_.add((speed - mean_.mean()) * std::cos(middle), weight);
      across_.add((speed - mean_.mean()) * std::sin(middle), weight);
    }
    window_turned_ = window_time_ = 0.0;
  }

  CrankSensor sensor_;
  std::optional<double> reading_;        ///< the last one [rad]
  RunningMean<> mean_{kTurns * kTwoPi};  ///< of the speed [rad/s]
  /// What is beside it, times cosine and sine of the angle.
  RunningMean<> along_{kTurns * kTwoPi}, across_{kTurns * kTwoPi};
  double window_turned_{}, window_time_{};
  double forward_{}, back_{};  ///< since it was furthest back, forward [rad]
  bool backward_{}, inconsistent_{};
  bool contradicted_{};  ///< it was inconsistent since it began
  int unbelieved_{};     ///< strokes in a row of which the estimate was not good enough to be published
};

}  // namespace hammer_loads
