/// How each mode moved in the last few milliseconds: what a reading whose stamp is late belongs to.
#pragma once

#include <array>
#include <cstddef>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/boom/lanes.h"
#include "hammer_loads/boom/mode.h"

namespace hammer_loads {

/// One entry a mode; zero for modes that there are not.
using ModeVector = Eigen::Matrix<double, kMaxJoints, 1>;
/// Of the modes `first`, a multiple of four, to the third after it.
HAMMER_LOADS_INLINE Lanes fourOf(const ModeVector& modes, int first) noexcept { return lanesAt(modes.data() + first); }

/// Four modes at an instant.
struct FourModes {
  Lanes x, v;               ///< as ModeState
  Lanes force, force_rate;  ///< modal, of the hammer; and by the second
};

/// The last steps of all modes, each from its begin to its end: between two of them blows and readings change what is
/// known. No allocation.
class ModeHistory {
 public:
  static constexpr std::size_t kSteps = 64;  ///< 12 ms at 5 kHz

  void clear() noexcept { count_ = 0; }
  /// A step [s] > 0 begins; set() each mode of it.
  void begin(double step) noexcept;
  void set(int mode, const ModeState& from, const ModeState& to, double force_from, double force_to) noexcept {
    Step& step = steps_[newest_];
    step.from_x[mode] = from.x, step.from_v[mode] = from.v, step.to_x[mode] = to.x, step.to_v[mode] = to.v;
    step.force_from[mode] = force_from, step.force_to[mode] = force_to, step.jump[mode] = 0.0;
  }
  /// A blow at the end of the last step [m sqrt(kg)/s].
  void strike(int mode, double jump) noexcept { steps_[newest_].jump[mode] += jump; }

  struct Place {
    std::size_t newer{};  ///< so many steps are newer than its own
    double ago{};         ///< [s]
    double since{};       ///< its step's begin [s]
  };
  /// So long before the present [s]. False: that is too long.
  bool find(double ago, Place& place) const noexcept;
  /// Modes `first`, a multiple of four, to the third after it. By cubics through both ends of a step, relative error
  /// (omega step)^4/384. now: what readings have shown since then counts for then as well.
  HAMMER_LOADS_INLINE void look(int first, const Place& place, const Lanes& omega, const FourModes& now,
                                FourModes& then) const noexcept;

 private:
  struct Step {
    double duration{};
    ModeVector from_x = ModeVector::Zero(), from_v = from_x, to_x = from_x, to_v = from_x;
    ModeVector force_from = from_x, force_to = from_x, jump = from_x;
  };
  const Step& stepWith(std::size_t newer) const noexcept { return steps_[(newest_ + kSteps - newer) % kSteps]; }

  std::array<Step, kSteps> steps_;
  std::size_t newest_{}, count_{};
};

inline void ModeHistory::look(int first, const Place& place, const Lanes& omega, const FourModes& now,
                              FourModes& then) const noexcept {
  const Step& step = stepWith(place.newer);
  const double h = step.duration, per_time = 1.0 / h, u = place.since * per_time, w = 1.0 - u;
  const Lanes from_x = fourOf(step.from_x, first), to_x = fourOf(step.to_x, first), moved = to_x - from_x;
  // What a straight line lacks at its ends.
  const Lanes lacks_first = h * fourOf(step.from_v, first) - moved, lacks_last = moved - h * fourOf(step.to_v, first);
  const Lanes force_from = fourOf(step.force_from, first), force_to = fourOf(step.force_to, first);
  then.x = w * from_x + u * to_x + u * w * (w * lacks_first + u * lacks_last);
  then.v = (moved + w * (w - 2.0 * u) * lacks_first + u * (2.0 * w - u) * lacks_last) * per_time;
  then.force = w * force_from + u * force_to;
  then.force_rate = (force_to - force_from) * per_time;
  Lanes after_x = now.x, after_v = now.v;  // begin of the next step
  const Lanes square = omega * omega;
  double t = -place.ago;
  for (std::size_t newer = 0; newer <= place.newer; ++newer) {
    const Step& its = stepWith(newer);
    // What was shown then, back without force, undamped: cosine and sine to the fifth power of omega t.
    const Lanes x = after_x - fourOf(its.to_x, first), xx = square * (t * t);
    const Lanes v = after_v - fourOf(its.to_v, first) - fourOf(its.jump, first);
    const Lanes cosine = 1.0 - xx * (0.5 - xx * (1.0 / 24.0)), sine = t * (1.0 - xx * (1.0 / 6.0 - xx * (1.0 / 120.0)));
    then.x += cosine * x + sine * v, then.v += cosine * v - square * sine * x;
    after_x = fourOf(its.from_x, first), after_v = fourOf(its.from_v, first);
    t += its.duration;
  }
}

}  // namespace hammer_loads
