/// Encoder of the crank: its mounting, and the conversion of its readings to the angle with counts, slips and lag.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Mounting of the sensor; the keys `crank_*` have the same names with the unit appended.
struct CrankSensorPlace {
  double zero{};                   ///< reading at the blow [rad]
  int direction{1};                ///< 1, or -1 for an encoder that counts against the crank's rotation
  double ratio{1.0};               ///< encoder revolutions per crank revolution [-], > 0
  double eccentricity[2]{};        ///< once and twice a revolution [rad], >= 0
  double eccentricity_phase[2]{};  ///< [rad]
};

/// reading = zero + direction ratio (angle + sum a_n [sin(n angle + phase_n) - sin(phase_n)]), n = 1, 2. The encoder is
/// off centre by a part a_1 of its radius, or oval. The terms vanish at the blow, so that the zero alone shows its
/// place. A measured speed is the derivative of the reading.
///
/// An encoder that is geared to the crank must not wrap its readings, unless its revolution is a whole number of the
/// crank's.
class CrankSensor {
 public:
  /// Creates a sensor whose reading is the angle, to the last bit.
  CrankSensor() = default;
  /// Refuses a direction other than 1 and -1, a ratio of 0, eccentricity with a ratio other than 1, and eccentricity by
  /// which the reading might turn back: a_1 + 2 a_2 >= 1.
  static Checked<CrankSensor> make(const CrankSensorPlace& place);

  /// Crank angle [rad], in the winding of the reading [rad].
  double angle(double reading) const noexcept;
  /// Crank speed [rad/s] from a measured one at a crank angle [rad].
  double speed(double angle, double measured) const noexcept;
  /// Crank angle per reading, its mean over the revolution [-].
  double gain() const noexcept { return gain_; }
  const CrankSensorPlace& place() const noexcept { return place_; }
  bool isIdentity() const noexcept { return identity_; }
  /// Reading [rad] at a crank angle [rad].
  double reading(double angle) const noexcept;
  /// Moves the mounting: readings are larger by that angle of the crank [rad] from now on.
  void slip(double angle) noexcept {
    place_.zero += angle / gain_;
    identity_ = false;
  }

 private:
  double excess(double angle) const noexcept;
  double slope(double angle) const noexcept;

  CrankSensorPlace place_;
  double offset_[2]{};  ///< a_n sin(phase_n) [rad]
  double gain_{1.0};    ///< direction/ratio
  bool identity_{true};
  bool centred_{true};
};

/// Smallest count; a sensor with finer readings is one without counts [rad].
constexpr double kFinestCount = kTwoPi / 65536.0;
/// Tolerance of a multiple, as part of a count: sensors in single precision round by 4e-4 of 2 pi/4096.
constexpr double kCountTolerance = 1e-3;
// Numerical: kCountTolerance
// Limit: kFinestCount

/// An encoder counts down to the last whole count, so a reading means the middle of its count. The count is identified
/// from the readings: the largest whole part of a revolution of which all their differences are multiples. Until there
/// are enough readings, the count is the given one or 2 pi/4096. Readings finer than 2 pi/65536 are those of a sensor
/// without counts: used directly, with the variance of the count assumed before, as their noise is not stated.
class Encoder {
 public:
  /// given: count [rad]; 0: to be identified.
  explicit Encoder(double given, const CrankSensor& place = {}) noexcept
      : place_(place), given_(given > 0.0), assumed_(given > 0.0 ? given : kUsual) {}

  /// Angle of the crank [rad].
  double angle(double reading) noexcept {
    learn(reading);
    return place_.angle(reading + 0.5 * (isFiner() ? 0.0 : resolution()));
  }
  /// Speed of the crank [rad/s], at its angle [rad].
  double speed(double angle, double measured) const noexcept { return place_.speed(angle, measured); }
  /// Follows a slip on the shaft: readings are larger by this angle of the crank [rad] from now on.
  void slip(double angle) noexcept { place_.slip(angle); }
  /// Crank angles between which a reading lies; the lower one within half a revolution of the blow [rad].
  struct Edges {
    double low, high;
  };
  Edges edges(double reading) const noexcept {
    if (place_.isIdentity()) return {CrankAngle::wrapToPi(reading), CrankAngle::wrapToPi(reading) + resolution()};
    const double one = place_.angle(reading), other = place_.angle(reading + resolution());
    const double low = CrankAngle::wrapToPi(one < other ? one : other);
    return {low, low + std::abs(other - one)};
  }

  const CrankSensor& place() const noexcept { return place_; }  ///< present mounting

  /// Variance of angle() [rad2]: uniform over the count.
  double variance() const noexcept {
    const double count = place_.gain() * resolution();
    return count * count / 12.0;
  }
  /// Count in use [rad of the encoder]; for a finer sensor the assumed one.
  double resolution() const noexcept { return isKnown() && !isFiner() ? count_ : assumed_; }
  bool isFiner() const noexcept { return finer_readings_ >= kEnough; }
  /// Returns true after enough readings to know the count.
  bool isKnown() const noexcept { return agreeing_ >= kEnoughToKnow; }
  /// Returns true if the readings contradict the given count.
  bool contradictsGiven() const noexcept {
    return given_ && (isFiner() || (isKnown() && std::abs(count_ / assumed_ - 1.0) > kCountTolerance));
  }

 private:
  static constexpr double kUsual = kTwoPi / 4096.0;  // Prior: kUsual
  static constexpr int kEnough = 2;
  static constexpr double kSame = kCountTolerance * kFinestCount;
  static constexpr int kEnoughStrays = 4;
  static constexpr int kEnoughToKnow = 24;  // differences; all even or multiples of three by chance: 1e-7

  static bool isMultiple(double difference, double count) noexcept {
    const double counts = difference / count, whole = std::nearbyint(counts);
    return whole >= 1.0 && std::abs(counts - whole) <= kCountTolerance;
  }

  static double between(double one, double other) noexcept { return std::abs(CrankAngle::wrapToPi(one - other)); }

  void learn(double reading) noexcept {
    if (!last_) last_ = reading;
    const double difference = between(reading, *last_);
    if (difference < kSame) return;
    const bool fits = isMultiple(difference, count_);
    if (!fits && isKnown() && isStray(reading)) return;
    last_ = reading;
    strays_ = 0;
    if (fits) {
      if (agreeing_ < kEnoughToKnow) ++agreeing_;
      if (isKnown()) finer_readings_ = 0;  // a damaged reading had suggested it
    } else {
      agreeing_ = 0;
      if (!isFiner() && !reduceTo(difference)) ++finer_readings_;
    }
  }

  /// Keeps a known count in spite of a damaged reading. Two readings that agree with each other are those of a sensor
  /// that was moved or has a finer count, which is then identified again. Several readings that agree with nothing are
  /// those of another sensor.
  bool isStray(double reading) noexcept {
    const double difference = strays_ > 0 ? between(reading, stray_) : 0.0;
    if (strays_ > 0 && difference < kSame) return true;
    stray_ = reading;
    if (strays_ > 0 && isMultiple(difference, count_)) {
      last_ = reading;
      strays_ = agreeing_ = 0;
      return true;
    }
    return ++strays_ < kEnoughStrays;
  }

  /// Reduces the count to the largest part of a revolution that also divides the difference (Euclid). False: none.
  bool reduceTo(double difference) noexcept {
    double large = count_, small = difference;
    for (int i = 0; i < 64 && small > 0.5 * kFinestCount; ++i) {
      const double rest = std::abs(large - small * std::nearbyint(large / small));
      large = small;
      small = rest < kCountTolerance * small ? 0.0 : rest;
    }
    const double whole = kTwoPi / std::nearbyint(kTwoPi / large);
    if (small > 0.0 || large < (1.0 - kCountTolerance) * kFinestCount || !isMultiple(difference, whole)) return false;
    count_ = whole;
    return true;
  }

  CrankSensor place_;
  bool given_;
  double assumed_;
  double count_{kTwoPi};  ///< largest that all differences so far allow [rad]
  std::optional<double> last_;
  double stray_{};  ///< the last reading that did not fit
  int strays_{};    ///< number of such readings in succession
  int agreeing_{};  ///< differences in a row that fit the count
  int finer_readings_{};
};

/// Detection of a slip. The crank's inertia limits unpredicted changes between two readings to some milliradians, and
/// they continue. If a reading is suddenly further off and the next one by the same amount, the sensor has moved by it,
/// to the count. The stamps must not jitter as much, and the blow must not be near. A clock that was set has the same
/// effect, but changes the length of the step. Large innovations in every revolution have another cause; some
/// revolutions without one are required before.
class EncoderSlip {
 public:
  enum class Step { kNone, kPerhaps, kSlipped };

  /// Largest innovation of a working machine between two samples [rad]. Beyond it the sensor is another one, and the
  /// estimate restarts.
  static constexpr double kMost = 0.5;
  // Limit: kMost

  /// Tests the innovation of an angle with its variance. by_torque: effect of the largest torque within the step; way:
  /// rotation in a step of usual length; longer: rotation in the excess of this step [rad]. possible: place and earlier
  /// samples allow it. kPerhaps: the sample must not be used; the next decides, with a step from the same sample.
  Step follow(double innovation, double total, double by_torque, double way, double longer, bool possible) noexcept {
    const double seen = std::exchange(seen_, 0.0), before = std::exchange(before_, innovation);
    if (seen != 0.0) {
      const bool stays = std::abs(innovation - seen) < kSame * std::abs(seen);
      before_ = 0.0;  // the sample changes once the encoder has moved
      if (!stays || std::abs(longer - way) > kOfClock * std::abs(innovation)) return Step::kNone;
      ++count_;
      turns_since_ = 0;
      last_ = 0.5 * (innovation + seen), deviation_ = std::sqrt(0.5 * total);
      return Step::kSlipped;
    }
    const bool jumped = std::abs(before) < kSame * std::abs(innovation);
    if (!possible || !jumped || std::abs(innovation) < by_torque || !exceeds(innovation, total, gate::kImpossible))
      return Step::kNone;
    const bool undoes = isFresh() && std::abs(innovation + last_) < kSame * std::abs(last_);
    const int quiet = std::exchange(quiet_turns_, 0);
    if ((quiet < look_back::kTurnsToKnow && !undoes) || std::abs(innovation) > kMost) return Step::kNone;
    if (std::abs(longer) > kOfClock * std::abs(innovation)) return Step::kNone;
    seen_ = innovation;
    return Step::kPerhaps;
  }
  void endTurn() noexcept { ++quiet_turns_, ++turns_since_; }
  int count() const noexcept { return count_; }             ///< since the beginning
  double last() const noexcept { return last_; }            ///< last step of the crank's angle [rad]
  double deviation() const noexcept { return deviation_; }  ///< standard deviation of last() [rad]

 private:
  /// Returns true if the last slip is at most some revolutions old, so that a step back belongs to it.
  bool isFresh() const noexcept { return last_ != 0.0 && turns_since_ < look_back::kTurnsToKnow; }

  static constexpr double kSame = 0.4;  // relative; a crank that was pushed is off by twice as much in the next sample
  static constexpr double kOfClock = 0.5;  // part of the innovation: a set clock changes the step as much
  double before_{};                        ///< innovation of the sample before [rad]
  double seen_{};                          ///< innovation that may be a slip [rad]; else 0
  double last_{}, deviation_{};
  int count_{}, quiet_turns_{}, turns_since_{};
};

/// First-order low-pass of the angle, lag y' = angle - y. For a constant acceleration within a step, angle - y is
/// exactly lag (w - lag w') plus the decaying initial value. A pure delay differs from it by lag^2 w'/2 alone. Measured
/// speeds reveal the lag (SpeedTrust), since they cannot be ahead of their crank.
class AngleLag {
 public:
  bool isThere() const noexcept { return lag_ > 0.0; }
  double lag() const noexcept { return lag_; }              ///< lag subtracted from the readings [s]
  double deviation() const noexcept { return deviation_; }  ///< standard deviation of lag() [s]
  /// Adds a remaining lag, found in readings from which lag() is subtracted [s]; deviation: standard deviation [s].
  void correct(double more, double deviation) noexcept {
    lag_ = std::max(0.0, lag_ + more);
    deviation_ = deviation;
  }
  /// Restarts the readings at a constant speed [rad/s].
  void begin(double speed) noexcept { behind_ = lag_ * speed; }
  /// Returns how far the reading is behind [rad] after a step of dt [s] > 0 from one speed to another [rad/s].
  double behind(double from, double to, double dt) const noexcept {
    if (!isThere()) return 0.0;
    const double bent = lag_ * (to - from) / dt;
    return lag_ * (to - bent) + std::exp(-dt / lag_) * (behind_ - lag_ * (from - bent));
  }
  /// Notes that the reading at the end of the last step was used.
  void go(double behind) noexcept { behind_ = behind; }

 private:
  double lag_{}, deviation_{}, behind_{};
};

}  // namespace hammer_loads
