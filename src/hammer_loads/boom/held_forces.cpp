#include "hammer_loads/boom/held_forces.h"

#include <algorithm>

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

double HeldForces::length() const noexcept {
  double sum = 0.0;
  forEach([&](const Piece& piece) { sum += piece.duration; });
  return sum;
}

void HeldForces::push(double step, const TorqueStep& modal) noexcept {
  if (count_ == kMost) pop();
  Piece& last = pieces_[(front_ + count_++) % kMost];
  last = {};
  last.duration = step;
  const auto count = modal.from.size();
  last.from.head(count) = modal.from, last.to.head(count) = modal.to, last.mean.head(count) = modal.mean;
}

void HeldForces::strike(const ModeVector& jump) noexcept {
  Piece& last = pieces_[(front_ + count_ - 1) % kMost];
  last.strikes = true, last.jump += jump;
}

Driven HeldForces::drivenAt(double ahead, const ModeVector& present) const noexcept {
  Driven driven;
  driven.force = present;
  double begin = 0.0;
  for (std::size_t i = 0; i < count_ && begin <= ahead; ++i) {
    const Piece& piece = pieces_[(front_ + i) % kMost];
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
    Piece& front = pieces_[front_];
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
