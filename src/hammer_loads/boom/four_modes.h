/// Four modes of vibration in the lanes of a vector; those that there are not are zero.
#pragma once

#include "hammer_loads/boom/lanes.h"
#include "hammer_loads/boom/mode_history.h"

namespace hammer_loads {

/// At an instant.
struct FourModes {
  Lanes x, v;               ///< as ModeState
  Lanes force, force_rate;  ///< modal, of the hammer; and by the second
};

/// Of the modes `first`, a multiple of four, to the third after it.
HAMMER_LOADS_INLINE Lanes fourOf(const ModeVector& modes, int first) noexcept { return lanesAt(modes.data() + first); }

/// Where four modes were. By cubics through both ends of a step, relative error (omega step)^4/384. now: what readings
/// have shown since then counts for then as well.
HAMMER_LOADS_INLINE void look(const ModeHistory& history, const ModeHistory::Place& place, int first,
                              const Lanes& omega, const FourModes& now, FourModes& then) noexcept {
  const ModeHistory::Step& step = history.stepWith(place.newer);
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
    const ModeHistory::Step& its = history.stepWith(newer);
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
