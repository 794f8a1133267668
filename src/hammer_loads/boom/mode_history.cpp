#include "hammer_loads/boom/mode_history.h"

#include <algorithm>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

/// Removes and returns the part up to `end` [-]; the rest remains.
HeldForces::Piece cut(HeldForces::Piece& piece, double end) noexcept {
  const ModeVector bump = 6.0 * (piece.mean - 0.5 * (piece.from + piece.to)), rise = piece.to - piece.from;
  HeldForces::Piece first;
  first.duration = end * piece.duration;
  first.from = piece.from;
  first.to = piece.from + end * rise + end * (1.0 - end) * bump;
  first.mean = piece.from + 0.5 * end * rise + end * (0.5 - end / 3.0) * bump;
  piece.mean = (piece.mean - end * first.mean) / (1.0 - end);
  piece.from = first.to;
  piece.duration -= first.duration;
  return first;
}

}  // namespace

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

double HeldForces::length() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < count_; ++i) sum += (*this)[i].duration;
  return sum;
}

void HeldForces::push(double step, const TorqueStep& modal) noexcept {
  if (count_ == kMost) pop();
  Piece& last = (*this)[count_++];
  last = {};
  last.duration = step;
  const auto count = modal.from.size();
  last.from.head(count) = modal.from, last.to.head(count) = modal.to, last.mean.head(count) = modal.mean;
}

void HeldForces::strike(const ModeVector& jump) noexcept {
  Piece& last = (*this)[count_ - 1];
  last.strikes = true, last.jump += jump;
}

Driven HeldForces::drivenAt(double ahead, const ModeVector& present) const noexcept {
  Driven driven;
  driven.force = present;
  double begin = 0.0;
  for (std::size_t i = 0; i < count_ && begin <= ahead; ++i) {
    const Piece& piece = (*this)[i];
    const double part = std::min(1.0, (ahead - begin) / piece.duration);
    driven.force = piece.from + part * (piece.to - piece.from);
    begin += piece.duration;
    if (begin <= ahead) driven.jump += piece.jump;
  }
  return driven;
}

HeldForces::Piece HeldForces::take(double most) noexcept {
  constexpr double kNone = 1e-9;  // part of a piece below which it is rounding
  // Numerical: kNone
  Piece all;
  ModeVector impulse = ModeVector::Zero();
  while (count_ > 0 && !all.strikes) {
    Piece& front = (*this)[0];
    const double part = (most - all.duration) / front.duration;
    if (!(part > kNone)) break;
    const bool whole = part > 1.0 - kNone;
    const Piece next = whole ? front : cut(front, part);
    if (whole) pop();
    if (!(all.duration > 0.0) && whole && (next.strikes || !(next.duration < most * (1.0 - kNone)))) return next;
    if (!(all.duration > 0.0)) all.from = next.from;
    all.duration += next.duration, all.to = next.to;
    all.strikes = next.strikes, all.jump = next.jump;
    impulse += next.duration * next.mean;
  }
  if (all.duration > 0.0) all.mean = impulse / all.duration;
  return all;
}

std::optional<DrivenAround> drivenAround(const ModeHistory& past, const HeldForces& coming, const ModeVector& present,
                                         double ahead, double deviation) noexcept {
  if (!(deviation > 0.0)) return std::nullopt;
  const auto at = [&](double when) { return when > 0.0 ? coming.drivenAt(when, present) : past.drivenAt(-when); };
  const Driven before = at(ahead - deviation), then = at(ahead), after = at(ahead + deviation);
  const double per_time = 0.5 / deviation;
  return DrivenAround{per_time * (after.force - before.force), per_time * (after.jump - before.jump),
                      0.5 * (after.force + before.force) - then.force, 0.5 * (after.jump + before.jump) - then.jump};
}

}  // namespace hammer_loads
