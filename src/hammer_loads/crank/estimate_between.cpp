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

/// Where the two ways pass the blow at different instants, each speed is taken over to the side that counts.
double speedOn(const CrankAngle& angle, double speed, Side from, double factor) noexcept {
  if (from == angle.side || std::abs(angle.offset) > 1.0 || !(speed > 0.0)) return speed;
  return angle.side == Side::kAfterBlow ? speed * factor : speed / factor;
}

}  // namespace

CrankEstimate estimateBetween(const BetweenSamples& s, double dt) noexcept {
  ShaftState state = s.before.state, back = s.now.state;
  const bool contact = !s.before.state.position.isMirrored() && !s.now.state.position.isMirrored();
  // A tool that was met before the dead centre leaves nothing to strike there, unless it was a blow at that after all.
  const bool tool_was_none = s.before.struck_early && !s.now.struck_early;
  const Passing passing{s.before.tool_met && !tool_was_none ? 1.0 : s.now.factor, contact};
  advanceState(s.step_model, dt, passing, state);
  const double part = dt / s.step;
  if (hasRunAway(s, state)) {
    state = s.before.state;
    state.position.turn(part * difference(s.now.state.position, s.before.state.position));
  }
  if (part > 0.0) advanceState(s.step_model, dt - s.step, passing, back);
  if (!(part > 0.0) || hasRunAway(s, back)) back = state;  // at the step's begin the way back does not count
  const double apart = part * difference(back.position, state.position);
  const Side forward_side = state.position.angle.side, back_side = back.position.angle.side;
  move(apart, back.position, state.position);
  const CrankAngle& angle = state.position.angle;
  const double forward_speed = speedOn(angle, state.speed, forward_side, passing.factor);
  const double back_speed = speedOn(angle, back.speed, back_side, passing.factor);
  state.speed = forward_speed + part * (back_speed - forward_speed);
  state.torque += part * (back.torque - state.torque);
  state.drive_inertia += part * (back.drive_inertia - state.drive_inertia);
  state.twist += part * (back.twist - state.twist);
  state.motor_speed += part * (back.motor_speed - state.motor_speed);
  state.log_stiffness += part * (back.log_stiffness - state.log_stiffness);
  state.log_odds += part * (back.log_odds - state.log_odds);
  ShaftModel there = s.model;
  there.setHullMotion(blend(s.before_hull, s.now_hull, part));
  return estimateOf(there, there(angle), state);
}

}  // namespace hammer_loads
