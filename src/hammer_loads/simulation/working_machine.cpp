#include "hammer_loads/simulation/working_machine.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace hammer_loads::simulation {
namespace {

constexpr double kPi = 3.141592653589793238;

Mechanism checked(const HammerParameters& parameters) {
  const Checked<Mechanism> made = Mechanism::make(parameters);
  if (made.value) return *made.value;
  std::string all;
  for (const std::string& problem : made.problems) all += (all.empty() ? "" : "; ") + problem;
  throw std::invalid_argument(all);
}

/// 0 before, 1 after, with a continuous slope in between.
double rise(double time, double from, double length) noexcept {
  const double x = std::clamp((time - from) / length, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// Largest value of the parabola through three points with the largest in the middle.
double parabolaPeak(const double* t, const double* f, double t2, double f2) noexcept {
  const double a = (f[0] - f[1]) / (t[0] - t[1]), b = (f2 - f[1]) / (t2 - t[1]);
  const double curvature = (b - a) / (t2 - t[0]);
  if (!(curvature < 0.0)) return f[1];
  const double slope = a - curvature * (t[0] - t[1]);  // at the middle point
  return f[1] - 0.25 * slope * slope / curvature;
}

}  // namespace

WorkingMachine::WorkingMachine(const MachineSettings& settings)
    : settings_(settings), links_(checked(settings.hammer), settings.level) {
  now_.before_blow = settings_.start_angle > kPi;
  now_.y[kOffset] = now_.before_blow ? settings_.start_angle - 2.0 * kPi : settings_.start_angle;
  rate_ = rate(now_);
  beginTurn(false);
}

double WorkingMachine::hullPitch(double time) const noexcept {
  double pitch = 0.0;
  for (std::size_t i = 1; i < settings_.boom.size(); ++i) {
    const JointMotion& joint = settings_.boom[i];
    pitch += joint.mean + joint.amplitude * std::sin(2.0 * kPi * time / joint.period + joint.phase);
  }
  return pitch;
}

Gravity WorkingMachine::gravityAt(double time) const noexcept {
  const double pitch = hullPitch(time);
  return {settings_.gravity * std::sin(pitch), -settings_.gravity * std::cos(pitch)};
}

double WorkingMachine::supplyFlow(double time) const noexcept {
  const DriveSettings& d = settings_.drive;
  const double open = rise(time, d.start_time, d.start_ramp) * (1.0 - rise(time, d.stop_time, d.stop_ramp));
  return d.flow * open *
         (1.0 + d.flow_variation * std::sin(2.0 * kPi * time / d.flow_variation_period) +
          d.ripple * std::sin(2.0 * kPi * d.ripple_frequency * time));
}

/// Leakage, relief valve, bypass; below zero pressure a check valve refills the line.
double WorkingMachine::valveFlow(double time, double pressure) const noexcept {
  const DriveSettings& d = settings_.drive;
  const double bypass = pressure < 0.0 ? d.bypass : d.bypass * rise(time, d.stop_time, d.stop_ramp);
  return (d.leakage + bypass) * pressure + d.relief_slope * std::max(0.0, pressure - d.relief_pressure);
}

double WorkingMachine::netTorque(const State& state) const noexcept {
  const DriveSettings& d = settings_.drive;
  const double w = state.y[kSpeed];
  return d.motor_displacement * state.y[kPressure] - d.coulomb_friction * std::tanh(w / d.friction_speed) -
         d.viscous_friction * w;
}

WorkingMachine::Vector WorkingMachine::rate(const State& state) const noexcept {
  const DriveSettings& d = settings_.drive;
  const double w = state.y[kSpeed], p = state.y[kPressure];
  const LinkBodies links = links_.at({state.y[kOffset], state.before_blow});
  const Gravity gravity = gravityAt(state.time);
  const ShaftView shaft = links_.shaft(links, gravity);
  const double torque = netTorque(state);
  double acceleration =
      (torque + shaft.weight_torque - 0.5 * shaft.inertia_slope * w * w) / (d.inertia + shaft.inertia);
  if (state.resting) acceleration = 0.0;
  const Load load = links_.load(links, w, acceleration, gravity);
  const double flow = supplyFlow(state.time), valves = valveFlow(state.time, p);
  Vector r{};
  r[kOffset] = w;
  r[kSpeed] = acceleration;
  r[kPressure] = (flow - d.motor_displacement * w - valves) / d.compliance;
  r[kImpulseX] = load.force_x;
  r[kImpulseZ] = load.force_z;
  r[kMotor] = d.motor_displacement * p * w;
  r[kFriction] = r[kMotor] - torque * w;
  r[kWeight] = shaft.weight_torque * w;
  r[kSupply] = flow * p;
  r[kValves] = valves * p;
  return r;
}

/// One Runge-Kutta step from now_, on the present side of the blow.
WorkingMachine::State WorkingMachine::step(double dt) const noexcept {
  const auto moved = [this](double by, const Vector& slope) {
    State state = now_;
    state.time += by;
    for (std::size_t i = 0; i < kSize; ++i) state.y[i] += by * slope[i];
    return state;
  };
  const Vector k2 = rate(moved(0.5 * dt, rate_));
  const Vector k3 = rate(moved(0.5 * dt, k2));
  const Vector k4 = rate(moved(dt, k3));
  Vector mean;
  for (std::size_t i = 0; i < kSize; ++i) mean[i] = (rate_[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
  return moved(dt, mean);
}

/// Part of the step dt, which passes the blow, until the offset is zero: bisection with false position (Illinois).
double WorkingMachine::timeToBlow(double dt) const noexcept {
  double low = 0.0, high = dt, f_low = now_.y[kOffset], f_high = step(dt).y[kOffset];
  if (f_low == 0.0) return 0.0;
  double t = dt;
  for (int i = 0; i < 60 && high - low > 1e-16; ++i) {
    t = low - f_low * (high - low) / (f_high - f_low);
    const double f = step(t).y[kOffset];
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
  while (now_.time < time) {
    if (now_.resting &&
        netTorque(now_) + links_.shaft(links_.at({0.0, false}), gravityAt(now_.time)).weight_torque > 0.0) {
      now_.resting = false;
      rate_ = rate(now_);
    }
    const double left = time - now_.time;
    double dt = std::min(settings_.step, left);
    State next = step(dt);
    const bool meets = now_.before_blow ? next.y[kOffset] > 0.0 : next.y[kOffset] < 0.0;
    if (meets) {
      dt = timeToBlow(dt);
      next = step(dt);
      next.y[kOffset] = 0.0;
    }
    if (dt == left) next.time = time;
    accept(next);
    if (meets) meetTool();
  }
}

/// Makes the next state the present one, still on its side of the blow.
void WorkingMachine::accept(const State& next) {
  const double before = rate_[kImpulseZ];
  Vector rate_next = rate(next);
  followForce(next, rate_next[kImpulseZ]);
  if (before <= 0.0 && rate_next[kImpulseZ] > 0.0) {
    const double part = (next.time - now_.time) * before / (before - rate_next[kImpulseZ]);
    current_.lobe_impulse_z = now_.y[kImpulseZ] + 0.5 * before * part;
  }
  now_ = next;
  rate_ = rate_next;
  if (now_.y[kSpeed] < 0.0) current_.whole = false;
  if (!now_.before_blow && now_.y[kOffset] > kPi) {
    now_.y[kOffset] -= 2.0 * kPi;
    now_.before_blow = true;
  } else if (now_.before_blow && now_.y[kOffset] < -kPi) {
    now_.y[kOffset] += 2.0 * kPi;
    now_.before_blow = false;
  }
}

void WorkingMachine::followForce(const State& next, double force_z) noexcept {
  Turn& c = current_;
  c.peak = std::max(c.peak, force_z);
  if (c.points == 2 && c.force[1] >= c.force[0] && c.force[1] > force_z)
    c.peak = std::max(c.peak, parabolaPeak(c.time, c.force, next.time, force_z));
  if (c.points == 2 && next.time == c.time[1]) return;
  c.time[0] = c.time[1];
  c.force[0] = c.force[1];
  c.time[1] = next.time;
  c.force[1] = force_z;
  c.points = std::min(c.points + 1, 2);
}

void WorkingMachine::beginTurn(bool whole) noexcept {
  current_ = Turn{};
  current_.start_time = now_.time;
  current_.impulse_x = now_.y[kImpulseX];
  current_.impulse_z = current_.lobe_impulse_z = now_.y[kImpulseZ];
  current_.whole = whole;
  current_.peak = rate_[kImpulseZ];
  current_.time[1] = now_.time;
  current_.force[1] = rate_[kImpulseZ];
  current_.points = 1;
}

/// now_ is at offset 0: forward it is a blow, backward a stop.
void WorkingMachine::meetTool() {
  if (now_.before_blow) {
    BlowTruth blow;
    blow.time = now_.time;
    blow.crank_speed = now_.y[kSpeed];
    blow.strike = links_.strike(blow.crank_speed);
    blow.turn_period = now_.time - current_.start_time;
    blow.turn_peak_force_z = current_.peak;
    blow.turn_impulse_x = now_.y[kImpulseX] - current_.impulse_x;
    blow.turn_impulse_z = now_.y[kImpulseZ] - current_.impulse_z;
    blow.last_lobe_impulse_z = now_.y[kImpulseZ] - current_.lobe_impulse_z;
    blow.whole_turn = current_.whole;
    blows_.push_back(blow);
    blow_energy_ += blow.strike.energy;
    ++turn_;
    now_.before_blow = false;
    rate_ = rate(now_);
    beginTurn(true);
  } else {
    const double total = settings_.drive.inertia + links_.shaft(links_.at({0.0, false}), {}).inertia;
    stop_energy_ += 0.5 * total * now_.y[kSpeed] * now_.y[kSpeed];
    now_.y[kSpeed] = 0.0;
    now_.resting = true;
    current_.whole = false;
    rate_ = rate(now_);
  }
}

CrankTruth WorkingMachine::truth() const noexcept {
  CrankTruth truth;
  truth.time = now_.time;
  truth.turn = turn_;
  truth.angle = now_.before_blow ? 2.0 * kPi + now_.y[kOffset] : now_.y[kOffset];
  truth.speed = now_.y[kSpeed];
  truth.acceleration = rate_[kSpeed];
  truth.net_torque = netTorque(now_);
  truth.pressure = now_.y[kPressure];
  truth.hull_pitch = hullPitch(now_.time);
  truth.load = links_.load(links_.at({now_.y[kOffset], now_.before_blow}), truth.speed, truth.acceleration,
                           gravityAt(now_.time));
  return truth;
}

EnergyAccount WorkingMachine::energy() const noexcept {
  const double inertia =
      settings_.drive.inertia + links_.shaft(links_.at({now_.y[kOffset], now_.before_blow}), {}).inertia;
  const double w = now_.y[kSpeed], p = now_.y[kPressure];
  return {now_.y[kMotor],  now_.y[kFriction],     now_.y[kWeight],
          now_.y[kSupply], now_.y[kValves],       blow_energy_,
          stop_energy_,    0.5 * inertia * w * w, 0.5 * settings_.drive.compliance * p * p};
}

std::vector<BlowTruth> WorkingMachine::takeBlows() { return std::exchange(blows_, {}); }

}  // namespace hammer_loads::simulation
