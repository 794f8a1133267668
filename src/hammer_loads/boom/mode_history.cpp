#include "hammer_loads/boom/mode_history.h"

#include <algorithm>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

/// After time t without force, undamped; cosine and sine to the fifth power of omega t.
ModeState swung(const ModeState& s, double omega, double t) noexcept {
  const double x = omega * t, xx = square(x);
  const double cosine = 1.0 - xx * (0.5 - xx / 24.0), sine_over_omega = t * (1.0 - xx * (1.0 / 6.0 - xx / 120.0));
  return {cosine * s.x + sine_over_omega * s.v, cosine * s.v - square(omega) * sine_over_omega * s.x};
}

}  // namespace

void ModeHistory::begin(double step) noexcept {
  newest_ = (newest_ + 1) % kSteps;
  count_ = std::min(count_ + 1, kSteps);
  steps_[newest_].duration = step;
}

bool ModeHistory::find(double ago, Place& place) const noexcept {
  double since = -ago;
  for (std::size_t newer = 0; newer < count_; ++newer) {
    since += stepWith(newer).duration;
    if (since < 0.0) continue;
    place = {newer, ago, since};
    return true;
  }
  return false;
}

void ModeHistory::find(int mode, const Place& place, double omega, const ModeState& now,
                       ModeThen& result) const noexcept {
  const auto k = static_cast<std::size_t>(mode);
  const Step& step = stepWith(place.newer);
  const OfMode& m = step.modes[k];
  const double h = step.duration, per_time = 1.0 / h;
  const double u = place.since * per_time, w = 1.0 - u, moved = m.to.x - m.from.x;
  const double first = h * m.from.v - moved, last = moved - h * m.to.v;  // what a straight line lacks at its ends
  ModeThen then;
  then.motion.x = w * m.from.x + u * m.to.x + u * w * (w * first + u * last);
  then.motion.v = (moved + w * (w - 2.0 * u) * first + u * (2.0 * w - u) * last) * per_time;
  then.force = w * m.force_from + u * m.force_to;
  then.force_rate = (m.force_to - m.force_from) * per_time;
  ModeState after = now;  // begin of the next step
  double end = place.ago;
  for (std::size_t newer = 0; newer <= place.newer; ++newer) {
    const OfMode& its = stepWith(newer).modes[k];
    const ModeState shown = swung({after.x - its.to.x, after.v - its.to.v - its.jump}, omega, -end);
    then.motion.x += shown.x, then.motion.v += shown.v;
    after = its.from;
    end -= stepWith(newer).duration;
  }
  result = then;
}

}  // namespace hammer_loads
