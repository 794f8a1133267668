#include "hammer_loads/crank/estimate_between.h"

#include <cmath>

namespace hammer_loads {
namespace {

/// Faster or further than any crank gets within the step.
bool hasRunAway(const BetweenSamples& s, const ShaftState& state) noexcept {
  return !(std::abs(state.speed) < s.most_speed &&
           std::abs(difference(state.position, s.before.state.position)) <= s.most_speed * s.step + 0.5 * kTwoPi);
}

/// Onto the way between both, `apart` from the forward one.
void move(double apart, const CrankPosition& back, CrankPosition& position) noexcept {
  if (position.angle.side == back.angle.side || position.isMirrored() || back.isMirrored()) {
    position.slide(apart);
  } else {
    position.turn(apart);
  }
}

/// Speed of a path on the relevant side of the blow, where the two paths pass it at different instants. A crank that
/// turns back makes no blow.
double speedOn(const CrankAngle& angle, const ShaftState& way, double factor, bool forward) noexcept {
  const double speed = way.speed;
  if (way.position.angle.side == angle.side || std::abs(angle.offset) > 1.0 || !(speed > 0.0) || !forward) return speed;
  return angle.side == Side::kAfterBlow ? speed * factor : speed / factor;
}

/// States of both paths after dt, at the place between them.
struct Ways {
  ShaftState forward, back;
  bool ran_away{};  ///< one of them, which the other stands for
};

Ways waysAfter(const BetweenSamples& s, double dt) noexcept {
  const ShaftState &before = s.before.state, &now = s.now.state;
  Ways ways{before, now};
  const bool contact = !before.position.isMirrored() && !now.position.isMirrored();
  // A tool that was met before the dead centre leaves nothing to strike there, unless it was a blow at that after all.
  const bool tool_was_none = s.before.struck_early && !s.now.struck_early;
  const Passing passing{s.before.tool_met && !tool_was_none ? 1.0 : s.now.factor, contact};
  advanceState(s.step_model, dt, passing, ways.forward);
  const double part = dt / s.step;
  if (hasRunAway(s, ways.forward)) {
    ways.ran_away = true;
    ways.forward = before;
    ways.forward.position.turn(part * difference(now.position, before.position));
  }
  const bool at_begin = !(part > 0.0);  // there the way back does not count
  if (!at_begin) advanceState(s.step_model, dt - s.step, passing, ways.back);
  const bool back_ran_away = !at_begin && hasRunAway(s, ways.back);
  ways.ran_away |= back_ran_away;
  if (at_begin || back_ran_away) ways.back = ways.forward;
  CrankPosition position = ways.forward.position;
  move(part * difference(ways.back.position, ways.forward.position), ways.back.position, position);
  const bool forward = now.position.blowsPassed() >= before.position.blowsPassed();
  for (ShaftState* way : {&ways.forward, &ways.back}) {
    way->speed = speedOn(position.angle, *way, passing.factor, forward);
    way->position = position;
  }
  return ways;
}

/// The load at the place between both samples, with the hull's motion there.
CrankEstimate estimateThere(const BetweenSamples& s, double dt, const ShaftState& state) noexcept {
  ShaftModel there = s.model;
  there.setHullMotion(blend(s.before_hull, s.now_hull, dt / s.step));
  return estimateOf(there(state.position.angle), state);
}

}  // namespace

CrankEstimate estimateBetween(const BetweenSamples& s, double dt) noexcept {
  const auto [forward, back, ran_away] = waysAfter(s, dt);
  const double part = dt / s.step;
  ShaftState state = forward;
  state.speed += part * (back.speed - state.speed);
  state.torque += part * (back.torque - state.torque);
  state.drive_inertia += part * (back.drive_inertia - state.drive_inertia);
  return estimateThere(s, dt, state);
}

std::optional<CrankWays> waysBetween(const BetweenSamples& s, double dt) noexcept {
  const Ways ways = waysAfter(s, dt);
  if (ways.ran_away) return std::nullopt;
  return CrankWays{estimateThere(s, dt, ways.forward), estimateThere(s, dt, ways.back)};
}

}  // namespace hammer_loads
