#include "hammer_loads/simulation/working_machine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/simulation/drive.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kSwing = 0.04;  // phase of the coupling's vibration in a step [rad]
// Numerical: kSwing

/// Returns the largest value of the parabola through three points with the largest in the middle.
double parabolaPeak(const double* t, const double* f, double t2, double f2) noexcept {
  const double a = (f[0] - f[1]) / (t[0] - t[1]), b = (f2 - f[1]) / (t2 - t[1]);
  const double curvature = (b - a) / (t2 - t[0]);
  if (!(curvature < 0.0)) return f[1];
  const double slope = a - curvature * (t[0] - t[1]);  // at the middle point
  return f[1] - 0.25 * slope * slope / curvature;
}

}  // namespace

WorkingMachine::WorkingMachine(const MachineSettings& settings)
    : settings_(settings),
      links_(mechanismFrom(settings.hammer), settings.level),
      crank_side_inertia_(settings.drive.inertia),
      step_(settings.step),
      draws_(settings.seed ^ kBlowSeed) {
  const DriveSettings& d = settings_.drive;
  if (flexible()) {
    motor_inertia_ = d.motor_share * d.inertia;
    crank_side_inertia_ = d.inertia - motor_inertia_;
    const double rate = 2.0 * kPi * d.coupling_frequency;
    const double both = motor_inertia_ * crank_side_inertia_ / d.inertia;
    stiffness_ = rate * rate * both;
    damping_ = 2.0 * d.coupling_damping * rate * both;
    step_ = std::min(step_, kSwing / rate);
  }
  drawBlow();
  now_.before_blow = settings_.start_angle > kPi;
  now_.y[kOffset] = now_.before_blow ? settings_.start_angle - 2.0 * kPi : settings_.start_angle;
  now_.outside = outsideAt(0.0);
  rate_ = rate(now_);
  beginTurn(false);
}

WorkingMachine::Outside WorkingMachine::outsideAt(double time) const noexcept {
  return {time, hullGravity(settings_, time), supplyFlow(settings_.drive, time)};
}

/// Returns the motor torque less friction.
double WorkingMachine::netTorque(const State& state) const noexcept {
  return simulation::netTorque(settings_.drive, state.y[kPressure],
                               flexible() ? state.y[kMotorSpeed] : state.y[kSpeed]);
}

/// Returns the torque that reaches the crank.
double WorkingMachine::shaftTorque(const State& state) const noexcept {
  if (!flexible()) return netTorque(state);
  return stiffness_ * state.y[kTwist] + damping_ * (state.y[kMotorSpeed] - state.y[kSpeed]);
}

WorkingMachine::Vector WorkingMachine::rate(const State& state) const noexcept {
  const DriveSettings& d = settings_.drive;
  const double w = state.y[kSpeed], p = state.y[kPressure];
  const LinkBodies links = links_.at(state.angle());
  const Outside& o = state.outside;
  const ShaftView shaft = links_.shaft(links, o.gravity);
  const double motor_torque = netTorque(state), torque = shaftTorque(state);
  const double motor_speed = flexible() ? state.y[kMotorSpeed] : w;
  double acceleration =
      (torque + shaft.weight_torque - 0.5 * shaft.inertia_slope * w * w) / (crank_side_inertia_ + shaft.inertia);
  if (state.resting) acceleration = 0.0;
  const Load load = links_.load(links, w, acceleration, o.gravity);
  const double valves = valveFlow(d, o.time, p);
  Vector r{};
  r[kOffset] = w;
  r[kSpeed] = acceleration;
  r[kPressure] = (o.flow - d.motor_displacement * motor_speed - valves) / d.compliance;
  r[kImpulseX] = load.force_x;
  r[kImpulseZ] = load.force_z;
  r[kMotor] = d.motor_displacement * p * motor_speed;
  r[kFriction] = r[kMotor] - motor_torque * motor_speed;
  r[kWeight] = shaft.weight_torque * w;
  r[kSupply] = o.flow * p;
  r[kValves] = valves * p;
  if (flexible()) {
    const double twisting = motor_speed - w;
    r[kTwist] = twisting;
    r[kMotorSpeed] = (motor_torque - torque) / motor_inertia_;
    r[kFriction] += damping_ * twisting * twisting;
  }
  return r;
}

/// Returns the state after one Runge-Kutta step from now_, on the present side of the blow.
WorkingMachine::State WorkingMachine::step(double dt) const noexcept {
  const double start = now_.outside.time;
  const Outside middle = outsideAt(start + 0.5 * dt), end = outsideAt(start + dt);
  const auto moved = [this](double by, const Vector& slope, const Outside& outside) {
    State state = now_;
    state.outside = outside;
    for (std::size_t i = 0; i < kSize; ++i) state.y[i] += by * slope[i];
    return state;
  };
  const Vector k2 = rate(moved(0.5 * dt, rate_, middle));
  const Vector k3 = rate(moved(0.5 * dt, k2, middle));
  const Vector k4 = rate(moved(dt, k3, end));
  Vector mean;
  for (std::size_t i = 0; i < kSize; ++i) mean[i] = (rate_[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
  return moved(dt, mean, end);
}

/// Returns the crank offset at which the present step must end: the dead centre, or a tool before it.
double WorkingMachine::eventOffset() const noexcept {
  const double early = -settings_.blow.tool_early;
  const bool awaited = now_.before_blow && !now_.mirrored && !now_.met && !next_blow_.blank;
  return awaited && early < 0.0 && now_.y[kOffset] < early ? early : 0.0;
}

/// Returns the part of the step dt up to `offset`, which the step passes, by false position (Illinois method).
double WorkingMachine::timeTo(double offset, double dt) const noexcept {
  double low = 0.0, high = dt, f_low = now_.y[kOffset] - offset, f_high = step(dt).y[kOffset] - offset;
  if (f_low == 0.0) return 0.0;
  double t = dt;
  for (int i = 0; i < 60 && high - low > 1e-16; ++i) {
    t = low - f_low * (high - low) / (f_high - f_low);
    const double f = step(t).y[kOffset] - offset;
    if (std::abs(f) < 1e-15) break;
    if (std::signbit(f) == std::signbit(f_high)) {
      high = t;
      f_high = f;
      f_low *= 0.5;
    } else {
      low = t;
      f_low = f;
      f_high *= 0.5;
    }
  }
  return t;
}

void WorkingMachine::advanceTo(double time) noexcept {
  while (now_.outside.time < time) {
    // Released at most once per instant: a torque that falls through zero would stop the crank again at once.
    if (now_.resting && released_ < now_.outside.time &&
        shaftTorque(now_) + links_.shaft(links_.at({0.0, false}), now_.outside.gravity).weight_torque > 0.0) {
      now_.resting = false;
      released_ = now_.outside.time;
      rate_ = rate(now_);
    }
    const double left = time - now_.outside.time;
    double dt = std::min(step_, left);
    State next = step(dt);
    const double event = eventOffset();
    const bool meets = now_.before_blow ? next.y[kOffset] > event : next.y[kOffset] < 0.0;
    if (meets) {
      dt = timeTo(event, dt);
      next = step(dt);
      next.y[kOffset] = event;
    }
    if (dt == left && next.outside.time != time) next.outside = outsideAt(time);
    accept(next);
    if (meets && event < 0.0) meetEarlyTool();
    if (meets && event == 0.0) passDeadCentre();
  }
}

/// Makes the next state the present one, still on its side of the blow.
void WorkingMachine::accept(const State& next) {
  now_ = next;
  rate_ = rate(now_);
  followForce();
  if (now_.y[kSpeed] < 0.0) current_.whole = false;
  if (!now_.before_blow && now_.y[kOffset] > kPi) {
    now_.y[kOffset] -= 2.0 * kPi;
    now_.before_blow = true;
  } else if (now_.before_blow && now_.y[kOffset] < -kPi) {
    now_.y[kOffset] += 2.0 * kPi;
    now_.before_blow = false;
    now_.met = false;
  }
}

void WorkingMachine::followForce() noexcept {
  Turn& c = current_;
  const double time = now_.outside.time, force_z = rate_[kImpulseZ];
  c.peak = std::max(c.peak, force_z);
  if (c.points == 2 && c.force[1] >= c.force[0] && c.force[1] > force_z)
    c.peak = std::max(c.peak, parabolaPeak(c.time, c.force, time, force_z));
  if (c.points == 2 && time == c.time[1]) return;
  c.time[0] = c.time[1];
  c.force[0] = c.force[1];
  c.time[1] = time;
  c.force[1] = force_z;
  c.points = std::min(c.points + 1, 2);
}

void WorkingMachine::beginTurn(bool whole) noexcept {
  current_ = Turn{};
  current_.start_time = now_.outside.time;
  current_.impulse_x = now_.y[kImpulseX];
  current_.impulse_z = now_.y[kImpulseZ];
  current_.whole = whole;
  current_.peak = rate_[kImpulseZ];
  current_.time[1] = now_.outside.time;
  current_.force[1] = rate_[kImpulseZ];
  current_.points = 1;
}

CrankTruth WorkingMachine::truth() const noexcept {
  CrankTruth truth;
  truth.time = now_.outside.time;
  truth.turn = turn_;
  truth.angle = now_.before_blow ? 2.0 * kPi + now_.y[kOffset] : now_.y[kOffset];
  truth.speed = now_.y[kSpeed];
  truth.twist = now_.y[kTwist];
  truth.motor_speed = flexible() ? now_.y[kMotorSpeed] : truth.speed;
  truth.mirrored = now_.mirrored;
  truth.acceleration = rate_[kSpeed];
  truth.pressure = now_.y[kPressure];
  truth.hull_pitch = hullPitch(settings_, now_.outside.time);
  truth.load = links_.load(links_.at(now_.angle()), truth.speed, truth.acceleration, now_.outside.gravity);
  const double rotor = crank_side_inertia_ * truth.acceleration + motor_inertia_ * rate_[kMotorSpeed];
  truth.drive_reaction_y = -settings_.hammer.drive_reaction_ratio * rotor;
  return truth;
}

EnergyAccount WorkingMachine::energy() const noexcept {
  const double inertia = crank_side_inertia_ + links_.shaft(links_.at(now_.angle()), {}).inertia;
  const double w = now_.y[kSpeed], p = now_.y[kPressure];
  const double motor = motor_inertia_ * now_.y[kMotorSpeed] * now_.y[kMotorSpeed];
  const double twist = stiffness_ * now_.y[kTwist] * now_.y[kTwist];
  EnergyAccount e;
  e.motor = now_.y[kMotor];
  e.friction = now_.y[kFriction];
  e.weight = now_.y[kWeight];
  e.supply = now_.y[kSupply];
  e.valves = now_.y[kValves];
  e.blows = blow_energy_;
  e.losses = loss_energy_;
  e.stops = stop_energy_;
  e.kinetic = 0.5 * inertia * w * w + 0.5 * motor + 0.5 * twist;
  e.stored = 0.5 * settings_.drive.compliance * p * p;
  return e;
}

std::vector<BlowTruth> WorkingMachine::takeBlows() { return std::exchange(blows_, {}); }

}  // namespace hammer_loads::simulation
