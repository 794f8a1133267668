#include "hammer_loads/boom/mode_history.h"

#include <algorithm>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {

void ModeHistory::begin(double step) noexcept {
  newest_ = (newest_ + 1) % kSteps;
  count_ = std::min(count_ + 1, kSteps);
  steps_[newest_].duration = step;
}

bool ModeHistory::reaches(double ago) const noexcept {
  if (count_ == 0) return true;
  double left = ago - steps_[newest_].duration;
  for (std::size_t newer = 0; newer < count_ && left > 0.0; ++newer) left -= stepWith(newer).duration;
  return !(left > 0.0);
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

ModeHistory::Moment ModeHistory::at(const Place& place, int mode, double omega, const ModeState& now) const noexcept {
  const Step& step = stepWith(place.newer);
  const double h = step.duration, per_time = 1.0 / h, u = place.since * per_time, w = 1.0 - u;
  const double from_x = step.from_x[mode], to_x = step.to_x[mode], moved = to_x - from_x;
  // Deviations of the end slopes from a straight line.
  const double lacks_first = h * step.from_v[mode] - moved, lacks_last = moved - h * step.to_v[mode];
  const double force_from = step.force_from[mode], force_to = step.force_to[mode];
  Moment then{{w * from_x + u * to_x + u * w * (w * lacks_first + u * lacks_last),
               (moved + w * (w - 2.0 * u) * lacks_first + u * (2.0 * w - u) * lacks_last) * per_time},
              w * force_from + u * force_to,
              (force_to - force_from) * per_time};
  ModeState after = now;  // begin of the next step
  double t = -place.ago;
  for (std::size_t newer = 0; newer <= place.newer; ++newer) {
    const Step& its = stepWith(newer);
    // Corrections since then, carried back without force, undamped: cosine and sine to the fifth power of omega t.
    const double x = after.x - its.to_x[mode], v = after.v - its.to_v[mode] - its.jump[mode], xx = square(omega * t);
    const double cosine = 1.0 - xx * (0.5 - xx / 24.0), sine = t * (1.0 - xx * (1.0 / 6.0 - xx / 120.0));
    then.state.x += cosine * x + sine * v, then.state.v += cosine * v - square(omega) * sine * x;
    after = {its.from_x[mode], its.from_v[mode]};
    t += its.duration;
  }
  return then;
}

Driven ModeHistory::drivenAt(double ago) const noexcept {
  Driven driven;
  double since = -ago;
  for (std::size_t newer = 0; newer < count_; ++newer) {
    const Step& step = stepWith(newer);
    driven.jump -= step.jump;
    since += step.duration;
    driven.force = step.force_from + std::max(0.0, since / step.duration) * (step.force_to - step.force_from);
    if (since >= 0.0) break;
  }
  return driven;
}

}  // namespace hammer_loads
