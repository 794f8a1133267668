/// Recognises a crank or a boom that sends another unit where radians and radians per second are required.
#pragma once

#include <cmath>
#include <optional>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// The units of a crank's messages.
enum class CrankUnit {
  kRadians,
  kDegrees,       ///< angle, speed or both
  kSpeedInRpm,    ///< turns a minute
  kSpeedInTurns,  ///< turns a second
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

/// The text of its warning.
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

/// Compares what the crank's angle turns with what its speed says, over stretches of a radian or more: a factor of 57.3
/// either way is degrees in one of them, 1/9.55 a speed in rpm, 6.28 one in turns a second, 1/6.28 an angle in turns.
/// A factor of -1 is a wrong sign. A hammer's crank is slow once in a revolution: what the angle turns between two such
/// places is its unit's revolution, whatever the speeds are and whether the angle is wrapped or not.
/// Where both would be in degrees, or no speed is measured, it looks for steps that repeat themselves, each faster than
/// any crank, but not so if they were degrees. Needs the raw samples, those that are refused as well; judges within
/// some 2 turns and takes nothing back before the samples contradict it. Degrees of both angle and speed below
/// `max_speed` [deg/s] look like radians.
class UnitCheck {
 public:
  /// No crank is faster [rad/s].
  /// gain: crank angle per reading [-], != 0.
  explicit UnitCheck(double max_speed, double gain = 1.0) noexcept : max_speed_(max_speed), gain_(std::abs(gain)) {}

  /// Sample dt after the one before it [s]; dt <= 0, a long pause and values that are not finite begin a new stretch.
  void add(double dt, double angle, std::optional<double> speed) noexcept;
  CrankUnit unit() const noexcept { return recognised_; }
  bool isOtherUnit() const noexcept { return recognised_ != CrankUnit::kRadians; }
  /// The last stretches speak for another unit, but not enough of them yet.
  bool suspects() const noexcept {
    return speed_votes_ >= kSuspicious || bound_votes_ >= kSuspicious || cycle_votes_ >= kSuspicious;
  }

 private:
  static constexpr int kSuspicious = 2;  ///< votes more for another unit than against

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
  double slow_time_{};             ///< moving within the bound since it was last beyond it [s]
  int speed_votes_{}, bound_votes_{}, cycle_votes_{};
  CrankUnit cycle_unit_{CrankUnit::kRadians};  ///< unit to which cycle_votes_ belong
  double last_step_{};                         ///< last step of the angle, except for steps back by a revolution
  /// Length of the cycles from one slow place of the crank to the next, in the angle's own unit.
  struct {
    double turned{}, time{};    ///< rotation and duration of the present window
    double mean{};              ///< rate [1/s]
    double length{}, before{};  ///< turned since the cycle began; in the one before
    bool slow{};
  } cycle_;
  CrankUnit speed_unit_{CrankUnit::kRadians};  ///< unit to which speed_votes_ belong
  CrankUnit recognised_{CrankUnit::kRadians};
};

/// A pitch joint beyond a whole turn [rad]: a boom in degrees, for it cannot reach there.
constexpr bool jointLooksLikeDegrees(double angle) noexcept { return angle > kTwoPi || angle < -kTwoPi; }

}  // namespace hammer_loads
