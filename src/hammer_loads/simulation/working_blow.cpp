#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

void WorkingMachine::drawBlow() noexcept {
  const BlowSettings& b = settings_.blow;
  const double part = draws_.uniform(), contact = draws_.uniform();
  next_blow_ = {b.restitution_low + part * (b.restitution_high - b.restitution_low), contact < b.blank_share};
}

/// Early contact: the rocker accelerates the tool and transfers its remaining speed at the dead centre.
void WorkingMachine::meetEarlyTool() {
  early_crank_speed_ = now_.y[kSpeed];
  early_ = links_.strikeTool(now_.angle(), early_crank_speed_, settings_.blow.early_tool_mass, crank_side_inertia_);
  early_time_ = now_.outside.time;
  blow_energy_ += early_->energy;
  now_.met = true;
  now_.y[kSpeed] = early_->crank_speed_after;
  rate_ = rate(now_);
}

/// Handles the dead centre, with now_ at offset 0. Forwards it is a blow or, without a tool, the passage to the
/// mirrored branch or back. Backwards it is a stop on the tool, unless the rocker is beyond it.
void WorkingMachine::passDeadCentre() {
  const bool forward = now_.before_blow;
  const bool strikes = forward && !now_.mirrored && !next_blow_.blank;
  if (strikes) {
    blow();
    ++turn_;
    now_.before_blow = now_.met = false;
    drawBlow();
    rate_ = rate(now_);
    beginTurn(true);
  } else if (forward || now_.mirrored) {
    turn_ += forward ? 1 : -1;
    if (forward && !now_.mirrored) drawBlow();
    now_.before_blow = !forward;
    now_.mirrored = forward != now_.mirrored;
    rate_ = rate(now_);
    beginTurn(false);
  } else {
    const double total = crank_side_inertia_ + links_.shaft(links_.at({0.0, false}), {}).inertia;
    stop_energy_ += 0.5 * total * now_.y[kSpeed] * now_.y[kSpeed];
    now_.y[kSpeed] = 0.0;
    now_.resting = true;
    current_.whole = false;
    rate_ = rate(now_);
  }
}

/// Ends the revolution and sets the crank's speed to that after the blow.
void WorkingMachine::blow() {
  const BlowSettings& b = settings_.blow;
  const double speed = now_.y[kSpeed];
  Strike strike =
      b.restitution_drawn ? links_.strike(speed, next_blow_.restitution, crank_side_inertia_) : links_.strike(speed);
  if (b.crank_loss > 0.0) {
    const double total = crank_side_inertia_ + links_.shaft(links_.at({0.0, false}), {}).inertia;
    const double w = strike.crank_speed_after, kept = (1.0 - b.crank_loss) * w;
    strike.linkage_loss += 0.5 * total * (w * w - kept * kept);
    strike.crank_speed_after = kept;
  }
  now_.y[kSpeed] = strike.crank_speed_after;
  blow_energy_ += strike.energy;
  loss_energy_ += strike.linkage_loss;
  BlowTruth truth;
  truth.time = early_ ? early_time_ : now_.outside.time;
  truth.crank_speed = early_ ? early_crank_speed_ : speed;
  truth.strike = early_.value_or(strike);
  if (early_) {
    truth.strike.energy += strike.energy;  // second contact with the tool
    truth.strike.crank_speed_after = now_.y[kSpeed];
    early_.reset();
  }
  truth.turn_period = now_.outside.time - current_.start_time;
  truth.turn_peak_force_z = current_.peak;
  truth.turn_impulse_x = now_.y[kImpulseX] - current_.impulse_x;
  truth.turn_impulse_z = now_.y[kImpulseZ] - current_.impulse_z;
  truth.whole_turn = current_.whole;
  blows_.push_back(truth);
}

}  // namespace hammer_loads::simulation
