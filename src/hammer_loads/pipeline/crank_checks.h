/// Checks of crank samples: values and order, units, direction of rotation, agreement with the model.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/pipeline/refusal.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Checks a sample's own values and its place in time.
class CrankSampleGate {
 public:
  struct Limits {
    double max_speed{};     ///< largest speed of any crank [rad/s]
    double stale_after{};   ///< age of the last sample from which on a new one restarts [s]
    double frozen_turn{};   ///< rotation beyond which a working sensor does not repeat an angle [rad]
    double frozen_speed{};  ///< speed above which a frozen angle stays frozen until it changes [rad/s]
  };
  explicit CrankSampleGate(const Limits& limits) : limits_(limits), stamps_(limits.stale_after) {}

  enum class Order { kFirst, kNext };
  struct Verdict {
    std::optional<Refusal> refusal;
    Order order{Order::kFirst};
    double step{};         ///< since the last accepted sample [s]
    bool speed_is_dead{};  ///< only zeros while the angle moves, as sent by drivers that do not measure the speed
  };

  /// Returns the reason why a sample's own values cannot be accepted, whatever its stamp; empty if they can.
  std::optional<Refusal> refusalOf(const CrankSample& sample) const noexcept;
  Verdict judge(StampNs stamp, const CrankSample& sample) noexcept;
  void accept(StampNs stamp, const CrankSample& sample) noexcept {
    stamps_.accept(stamp);
    accepted_ = sample;
  }
  void setFrozenTurn(double turn) noexcept { limits_.frozen_turn = turn; }  ///< [rad], as Limits
  const std::optional<StampNs>& last() const noexcept { return stamps_.last(); }
  bool angleIsFrozen() const noexcept { return frozen_; }  ///< the last sample was refused for that

 private:
  bool isFrozen(double step, const CrankSample& sample) noexcept;
  bool isSpeedDead(const CrankSample& sample) const noexcept;

  Limits limits_;
  StampOrder stamps_;
  CrankSample accepted_;  ///< last
  bool frozen_{};         ///< true while the reading has not changed though the crank turned
};

/// Judges the readings of each accepted sample, not the filter's estimate, which may be wrong. While there is a refusal
/// nothing is published: no wrench, no blow, no pulse, no load cycle.
class CrankTrust {
 public:
  /// CrankFilter::strikeConsistency() beyond which readings contradict the model. It is 5 with a zero 30 deg off and
  /// 6.5 with a crank that turns backward. It is 2.5 with a zero 2 deg off, and below 2 with an elastic rod
  /// (crank_trust_test).
  static constexpr double kMost = mismatch::kContradicts;
  /// Threshold of CrankFilter::consistency() for a warning that withholds nothing. A correct machine has 0.9, a machine
  /// with a zero 2 deg off has 2.
  static constexpr double kInconsistent = mismatch::kUnexplained;

  explicit CrankTrust(const CrankSensor& sensor) noexcept : sensor_(sensor) {}

  /// Judges a reading of the angle [rad]. strike_consistency: CrankFilter's, NaN where it is not known. step: since the
  /// previous sample [s]; 0 after a restart, over which the rotation is not known.
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
  /// Returns true if the estimate before the blow was not good enough in several successive revolutions.
  bool isLost() const noexcept { return unpublished_ == kUnpublished; }
  std::optional<Refusal> refusal() const noexcept {
    if (backward_) return Refusal::kBackward;
    return isInconsistent() ? std::make_optional(Refusal::kInconsistent) : std::nullopt;
  }

 private:
  /// Number of successive strokes. With a correct model one in a hundred is not published, after lost samples. With a
  /// zero 30 deg off on a machine with an elastic rod, or without a tool, nine in ten are not published.
  static constexpr int kUnpublished = 2;
  static constexpr double kRunUp = 1.0;  ///< [rad]: more than the noise of readings, less than the motion at a blow
  // Limit: kRunUp
  /// Judges the direction of rotation. A stopping hammer that falls back on its tool turns backward by less than half a
  /// revolution, since the rocker cannot pass the dead centre backward.
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
  double forward_{}, back_{};      ///< rotation since the rearmost and since the foremost point [rad]
  bool backward_{}, inconsistent_{};
  int unpublished_{};  ///< successive strokes without an estimate that was good enough to be published
};

/// The units of a crank's messages.
enum class CrankUnit {
  kRadians,
  kDegrees,       ///< angle, speed or both
  kSpeedInRpm,    ///< revolutions per minute
  kSpeedInTurns,  ///< revolutions per second
  kAngleInTurns,
  kAngleInCounts,  ///< angle in the encoder's counts
  kSpeedSign,      ///< the speed's sign is not that of the angle's change
};

constexpr bool isOfAngle(CrankUnit unit) noexcept {
  return unit == CrankUnit::kAngleInTurns || unit == CrankUnit::kAngleInCounts;
}
constexpr bool isOfSpeed(CrankUnit unit) noexcept {
  return unit == CrankUnit::kSpeedInRpm || unit == CrankUnit::kSpeedInTurns || unit == CrankUnit::kSpeedSign;
}

/// Returns the text of the warning about a unit.
constexpr const char* textOf(CrankUnit unit) noexcept {
  switch (unit) {
    case CrankUnit::kDegrees:
      return "angle or speed is in degrees, must be in radians";
    case CrankUnit::kSpeedInRpm:
      return "speed is in rpm, must be in rad/s";
    case CrankUnit::kSpeedInTurns:
      return "speed is in turns per second, must be in rad/s";
    case CrankUnit::kAngleInTurns:
      return "angle is in turns, must be in radians";
    case CrankUnit::kAngleInCounts:
      return "angle is in encoder counts, must be in radians";
    case CrankUnit::kSpeedSign:
      return "speed has the opposite sign of the angle's change";
    case CrankUnit::kRadians:
      break;
  }
  return "angle and speed are in radians";
}

/// Compares the rotation by the crank's angle with that by its speed, over stretches of a radian or more. A factor of
/// 57.3 either way means degrees in one of them, 1/9.55 a speed in rpm. 6.28 means a speed in turns per second, 1/6.28
/// an angle in turns. A factor of -1 is a wrong sign. A hammer's crank is slow once per revolution. The rotation
/// between two slow places is a revolution in the angle's unit, at any speed and with or without wrapping. If both are
/// in degrees, or without a speed, it looks for repeated steps that are faster than any crank, but plausible in
/// degrees. It needs all raw samples, including refused ones. It decides within some 2 revolutions and revokes nothing
/// before samples contradict it. Degrees of both angle and speed below `max_speed` [deg/s] look like radians.
class UnitCheck {
 public:
  /// max_speed: no crank is faster [rad/s]. gain: crank angle per reading [-], != 0.
  explicit UnitCheck(double max_speed, double gain = 1.0) noexcept : max_speed_(max_speed), gain_(std::abs(gain)) {}

  /// Adds a sample dt [s] after the previous one. dt <= 0, a long pause or values that are not finite begin a new
  /// stretch.
  void add(double dt, double angle, std::optional<double> speed) noexcept;
  CrankUnit unit() const noexcept { return recognised_; }
  bool isOtherUnit() const noexcept { return recognised_ != CrankUnit::kRadians; }
  /// Returns true if the last stretches indicate another unit. Recognising it needs more of them.
  bool suspects() const noexcept {
    return speed_votes_ >= kSuspicious || bound_votes_ >= kSuspicious || cycle_votes_ >= kSuspicious;
  }

 private:
  static constexpr int kSuspicious = 2;  ///< surplus of votes for another unit
  // Limit: kSuspicious

  void begin(double angle) noexcept;
  void compareWithSpeed(double step, double predicted) noexcept;
  void compareWithBound(double dt, double rate) noexcept;
  void followCycle(double dt, double turned) noexcept;
  void vote(int& votes, CrankUnit unit) noexcept;

  double max_speed_, gain_;
  std::optional<double> last_angle_;
  double last_rate_{};             ///< rate of the angle over the last step [rad/s]
  double turned_{}, predicted_{};  ///< rotation over this stretch, by angles and by speeds [rad]
  double suspected_for_{};         ///< time since the votes became suspicious [s]
  double slow_time_{};             ///< time of motion within the bound since it was last exceeded [s]
  int speed_votes_{}, bound_votes_{}, cycle_votes_{};
  CrankUnit cycle_unit_{CrankUnit::kRadians};  ///< unit to which cycle_votes_ belong
  double last_step_{};                         ///< last step of the angle, except for steps back by a revolution
  /// Length of the cycles from one slow place of the crank to the next, in the angle's own unit.
  struct {
    double turned{}, time{};    ///< rotation and duration of the present window
    double mean{};              ///< rate [1/s]
    double length{}, before{};  ///< rotation since the cycle began, and in the previous cycle
    bool slow{};
  } cycle_;
  CrankUnit speed_unit_{CrankUnit::kRadians};  ///< unit to which speed_votes_ belong
  CrankUnit recognised_{CrankUnit::kRadians};
};

/// Returns true if a pitch joint's angle is beyond a revolution [rad]. No boom reaches it, so that it is in degrees.
constexpr bool jointLooksLikeDegrees(double angle) noexcept { return angle > kTwoPi || angle < -kTwoPi; }

}  // namespace hammer_loads
