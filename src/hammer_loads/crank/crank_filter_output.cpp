// What the filter gives: its estimate at a sample and between the last two, with deviations.
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"

namespace hammer_loads {

void CrankFilter::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  load_ = model_(now_.state.position.angle);
}

BlowFactor CrankFilter::blowFactor() const noexcept {
  const ShaftMatrix covariance = grown(now_);
  const auto deviation = [&](CrankBelief::Row row) { return std::sqrt(covariance(row, row)); };
  return {now_.factor, deviation(CrankBelief::kFactor), now_.state.drive_inertia, deviation(CrankBelief::kInertia)};
}

bool CrankFilter::isPlausible() const noexcept { return std::abs(now_.state.torque) <= mostTorque(); }

/// Faster or further than any crank gets within the last step.
bool CrankFilter::hasRunAway(const ShaftState& state) const noexcept {
  return !(std::abs(state.speed) < mostSpeed() &&
           std::abs(difference(state.position, before_.state.position)) <= mostSpeed() * step_ + 0.5 * kTwoPi);
}

/// The way forward from the earlier sample and the way back from the later one, each trusted near its own end. Between
/// samples that no machine makes either may run away; it is left out then.
CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  ShaftState state = before_.state, back = now_.state;
  const bool contact = !before_.state.position.isMirrored() && !now_.state.position.isMirrored();
  const Passing passing{before_.tool_met ? 1.0 : now_.factor, contact};
  advanceState(step_model_, dt, passing, state);
  const double part = dt / step_;
  if (hasRunAway(state)) {
    state = before_.state;
    state.position.turn(part * difference(now_.state.position, before_.state.position));
  }
  if (part > 0.0) advanceState(step_model_, dt - step_, passing, back);
  if (!(part > 0.0) || hasRunAway(back)) back = state;  // at the step's begin the way back does not count
  const double apart = part * difference(back.position, state.position);
  const Side forward_side = state.position.angle.side, back_side = back.position.angle.side;
  const bool smooth = forward_side == back_side || state.position.isMirrored() || back.position.isMirrored();
  if (smooth) {
    state.position.slide(apart);
  } else {
    state.position.turn(apart);
  }
  // Where the two ways pass the blow at different instants, each speed is taken over to the side that counts.
  const auto speedOn = [&](double speed, Side from) {
    if (from == state.position.angle.side || std::abs(state.position.angle.offset) > 1.0 || !(speed > 0.0))
      return speed;
    return state.position.angle.side == Side::kAfterBlow ? speed * passing.factor : speed / passing.factor;
  };
  const double forward_speed = speedOn(state.speed, forward_side), back_speed = speedOn(back.speed, back_side);
  state.speed = forward_speed + part * (back_speed - forward_speed);
  state.torque += part * (back.torque - state.torque);
  state.drive_inertia += part * (back.drive_inertia - state.drive_inertia);
  ShaftModel there = model_;
  there.setHullMotion(blend(before_hull_, now_hull_, dt / step_));
  return {state.position, state.speed, acceleration(there(state.position.angle), state)};
}

Eigen::Matrix3d CrankFilter::covarianceBetween(double dt, double torque_part) const noexcept {
  if (dt >= step_) return motionCovariance(torque_part);
  CrankBelief belief = before_;
  predict(dt, true, belief);
  return hammer_loads::motionCovariance(model_, belief, grown(belief), torque_part);
}

/// By what the innovations show beyond the model, and by the sensor's errors, which are not corrected.
ShaftMatrix CrankFilter::grown(const CrankBelief& belief) const noexcept {
  const SensorErrors::Effect& effect = belief.by_error;
  return consistency_.growth() * belief.covariance + (effect * errors_.moment()) * effect.transpose();
}

}  // namespace hammer_loads
