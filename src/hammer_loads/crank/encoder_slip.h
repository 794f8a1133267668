/// An encoder that slips on its shaft, or a counter that loses its reference: the zero steps at an instant.
#pragma once

#include <cmath>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

/// A crank has inertia: from one reading to the next no torque moves it by more than some milliradians, and what moves
/// it goes on. A reading that is suddenly further off, and whose next one is off by the same, is of a sensor that
/// moved; the step itself says by how much, to the count. Stamps must not jitter by as much (a clock that was set looks
/// alike, but makes its step longer or shorter), and the blow must not be near. A model that is surprised in every
/// turn is wrong otherwise: some turns without must have gone before.
class EncoderSlip {
 public:
  enum class Step { kNone, kPerhaps, kSlipped };

  /// [rad]: an innovation that no working machine makes between two samples; the sensor is another one, and the
  /// estimate begins anew.
  static constexpr double kMost = 0.5;
  // Guard: EncoderSlip.NorIsASensorThatIsSomewhereElse of kMost

  /// An innovation of an angle, its variance, and what the largest torque does within the step [rad]. way: of the crank
  /// in a step of usual length; longer: in what this one lasts beyond that [rad]. possible: place and samples before
  /// allow it. kPerhaps: the sample is not to be taken; only the next one says, whose step then begins at the same one.
  Step follow(double innovation, double total, double by_torque, double way, double longer, bool possible) noexcept {
    const double seen = std::exchange(seen_, 0.0), before = std::exchange(before_, innovation);
    if (seen != 0.0) {
      const bool stays = std::abs(innovation - seen) < kSame * std::abs(seen);
      before_ = 0.0;  // the sample is another one once the encoder has moved
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
  /// The last one is some turns old at most: a step back belongs to it, and a restart says that it was none.
  bool isFresh() const noexcept { return last_ != 0.0 && turns_since_ < look_back::kTurnsToKnow; }
  /// The last one was none.
  void takeBack() noexcept {
    --count_;
    last_ = 0.0;
  }
  int count() const noexcept { return count_; }             ///< since the beginning
  double last() const noexcept { return last_; }            ///< of the crank's angle [rad]
  double deviation() const noexcept { return deviation_; }  ///< of that [rad]

 private:
  static constexpr double kSame = 0.4;     // of it: a crank that was pushed is off by twice as much in the next sample
  static constexpr double kOfClock = 0.5;  // of it: a clock that was set makes the step as much longer or shorter
  // Guard: EncoderSlip.IsAboutTheSameInTheNextReading of kSame
  // Guard: EncoderSlip.NorAClockThatWasSetNorASurpriseOfEachTurn of kOfClock
  double before_{};  ///< innovation of the sample before [rad]
  double seen_{};    ///< the same where it may be a slip; else 0
  double last_{}, deviation_{};
  int count_{}, quiet_turns_{}, turns_since_{};
};

}  // namespace hammer_loads
