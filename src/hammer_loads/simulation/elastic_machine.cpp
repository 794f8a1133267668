#include "hammer_loads/simulation/elastic_machine.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>

#include "hammer_loads/simulation/drive.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kLongestStep = 1e-4;  // step that is shorter than any contact [s]
constexpr double kShortest = 1e-8;     // step in which a contact may begin or end [s]
/// Largest error of a step: angles [rad], their speeds [rad/s], tool's way and speed [m], [m/s], yielded [m], pressure
/// [Pa]. 1e-11 rad corresponds to 0.5 N in a rod of 1e9 N/m.
constexpr double kError[] = {1e-11, 1e-11, 1e-6, 1e-6, 1e-11, 1e-6, 1e-11, 10.0};

}  // namespace

ElasticMachine::ElasticMachine(const MachineSettings& settings)
    : settings_(settings),
      links_(settings.hammer, settings.level),
      rod_(settings.rod),
      struck_(settings),
      longest_step_(std::min(settings.step, kLongestStep)),
      next_step_(longest_step_) {
  const double start = settings_.start_angle;
  now_[kCrank] = start > kPi ? start - kTwoPi : start;
  now_[kRocker] = links_.rockerAngle(start);
  contacts_ = contacts(now_);
  rate(now_, slope_, time_);
  view_ = now_;
}

StruckTool::Striker ElasticMachine::striker(const State& y) const noexcept {
  const std::complex<double> rocker = ElasticLinks::rockerAt(y[kRocker]);
  return {links_.depth(rocker), links_.depthSlope(rocker) * y[kRockerSpeed]};
}

ElasticMachine::Acting ElasticMachine::acting(const State& y, double time) const noexcept {
  Acting a;
  const Gravity g = hullGravity(settings_, time);
  const TwoBodies w = speeds(y);
  const ElasticLinks::View view = links_.at(angles(y), w);
  const double rate = view.rod.rate(w);
  a.rod = rod_.tension(view.rod.stretch, rate);
  a.rod_loss = (a.rod - rod_.tension(view.rod.stretch, 0.0)) * rate;
  const double depth_slope = links_.depthSlope(view.rocker);
  a.struck = struck_.answer({links_.depth(view.rocker), depth_slope * y[kRockerSpeed]}, tool(y), -g.z);
  a.net_torque = netTorque(settings_.drive, y[kPressure], w[0]);
  const TwoBodies weight = links_.weight(view, g), speeds = links_.inertiaOfSpeeds(view);
  const double up = a.struck.tool + a.struck.retainer;
  const double on_crank = a.net_torque + weight[0] + speeds[0] - a.rod * view.rod.slope[0];
  const double on_rocker = weight[1] + speeds[1] - a.rod * view.rod.slope[1] - up * depth_slope;
  std::array<double, 3> M = links_.inertia(view);
  M[0] += settings_.drive.inertia;
  const double determinant = M[0] * M[2] - M[1] * M[1];
  a.acceleration = {(M[2] * on_crank - M[1] * on_rocker) / determinant,
                    (M[0] * on_rocker - M[1] * on_crank) / determinant};
  a.load = links_.load(view, a.acceleration, g, a.struck.tool);
  a.weight = weight[0] * w[0] + weight[1] * w[1];
  if (struck_.isThere()) a.weight += settings_.strike.tool_mass * -g.z * y[kToolSpeed];
  return a;
}

void ElasticMachine::rate(const State& y, State& r, double time) const noexcept {
  const DriveSettings& d = settings_.drive;
  const Acting a = acting(y, time);
  const double w = y[kCrankSpeed], p = y[kPressure];
  r[kCrank] = w, r[kRocker] = y[kRockerSpeed];
  r[kCrankSpeed] = a.acceleration[0], r[kRockerSpeed] = a.acceleration[1];
  r[kToolWay] = a.struck.rate.way, r[kToolSpeed] = a.struck.rate.speed, r[kYielded] = a.struck.rate.yielded;
  r[kPressure] = (supplyFlow(d, time) - d.motor_displacement * w - valveFlow(d, time, p)) / d.compliance;
  r[kImpulseX] = a.load.force_x, r[kImpulseZ] = a.load.force_z;
  r[kMotor] = d.motor_displacement * p * w;
  r[kFriction] = r[kMotor] - a.net_torque * w;
  r[kWeight] = a.weight;
  r[kRodLoss] = a.rod_loss;
  r[kBlowLoss] = a.struck.contact_loss + a.struck.rock_loss + a.struck.retainer_loss;
  r[kToolImpulse] = a.struck.tool, r[kToolEnergy] = a.struck.tool * striker(y).speed;
  r[kRetainerImpulse] = a.struck.retainer;
}

/// Returns a code of the contacts at tool, retainer, rock and the two sides of the joint clearance.
int ElasticMachine::contacts(const State& y) const noexcept {
  const int ground = struck_.contacts(striker(y), tool(y));
  if (settings_.rod.play == 0.0) return ground;
  const double pressed = rod_.pressed(links_.rod(angles(y)).stretch);
  return ground + (pressed > 0.0 ? 8 : 0) + (pressed < 0.0 ? 16 : 0);
}

void ElasticMachine::step() {
  boost::numeric::odeint::runge_kutta_dopri5<State> stepper;
  const auto system = [this](const State& y, State& slope, double time) { rate(y, slope, time); };
  double dt = next_step_;
  for (;;) {
    State next, slope, error;
    stepper.do_step(system, now_, slope_, time_, next, slope, dt, error);
    double worst = 1e-8;
    for (int i = 0; i < kControlled; ++i) worst = std::max(worst, std::abs(error[i]) / kError[i]);
    const double factor = std::clamp(0.9 * std::pow(worst, -0.2), 0.1, 4.0);
    if (worst > 1.0 && dt > kShortest) {
      dt *= factor;
      continue;
    }
    const int after = contacts(next);
    if (after != contacts_ && dt > kShortest) {
      dt = std::max(0.25 * dt, 0.9 * kShortest);
      continue;
    }
    next_step_ = std::min(longest_step_, dt * factor);
    return accept(next, slope, dt, after);
  }
}

/// Returns the state at a time within the last step.
ElasticMachine::State ElasticMachine::stateAt(double time) const {
  if (time == time_) return now_;
  boost::numeric::odeint::runge_kutta_dopri5<State> stepper;
  const auto system = [this](const State& y, State& slope, double t) { rate(y, slope, t); };
  State view = before_, slope;
  if (time > before_time_)
    stepper.do_step(system, before_, before_slope_, before_time_, view, slope, time - before_time_);
  return view;
}

void ElasticMachine::advanceTo(double time) {
  while (time_ < time) {
    before_ = now_, before_slope_ = slope_, before_time_ = time_, view_turn_ = turn_, view_put_back_ = put_back_;
    step();
  }
  asked_ = time;
  view_ = stateAt(time);
  if (time == time_) view_turn_ = turn_, view_put_back_ = put_back_;
}

void ElasticMachine::accept(const State& next, const State& slope, double dt, int contacts) {
  const bool put_back = now_[kRocker] <= 1.0 && next[kRocker] > 1.0;  // rocker far from the tool, on its way up
  now_ = next, slope_ = slope, contacts_ = contacts;
  time_ += dt;
  current_.peak = std::max(current_.peak, slope_[kImpulseZ]);
  if (now_[kCrankSpeed] < 0.0) current_.whole = false;
  passDeadCentre();
  followBlow();
  if (put_back) putToolBack();
}

/// Keeps the crank angle within half a revolution of the nearest dead centre, whose number is turn_.
void ElasticMachine::passDeadCentre() noexcept {
  if (now_[kCrank] > kPi) {
    now_[kCrank] -= kTwoPi, ++turn_;
  } else if (now_[kCrank] < -kPi) {
    now_[kCrank] += kTwoPi, --turn_;
  }
}

CrankTruth ElasticMachine::truth() const noexcept {
  const Acting a = acting(view_, asked_);
  CrankTruth t;
  t.time = asked_;
  const bool before = view_[kCrank] < 0.0;
  t.turn = before ? view_turn_ - 1 : view_turn_;
  t.angle = before ? view_[kCrank] + kTwoPi : view_[kCrank];
  if (t.angle >= kTwoPi) t.angle = std::nextafter(kTwoPi, 0.0);
  t.speed = t.motor_speed = view_[kCrankSpeed];
  t.acceleration = a.acceleration[0];
  t.pressure = view_[kPressure];
  t.hull_pitch = hullPitch(settings_, asked_);
  t.load = a.load;
  t.drive_reaction_y = -settings_.hammer.drive_reaction_ratio * settings_.drive.inertia * a.acceleration[0];
  t.rocker_angle = view_[kRocker], t.rocker_speed = view_[kRockerSpeed];
  t.rod_force = -a.rod;
  t.tool_force = a.struck.tool, t.retainer_force = a.struck.retainer;
  return t;
}

ElasticEnergy ElasticMachine::energy() const noexcept {
  const TwoBodies w = speeds(view_);
  const ElasticLinks::View view = links_.at(angles(view_), w);
  const std::array<double, 3> M = links_.inertia(view);
  ElasticEnergy e;
  e.motor = view_[kMotor], e.friction = view_[kFriction], e.weight = view_[kWeight];
  e.kinetic = 0.5 * ((M[0] + settings_.drive.inertia) * w[0] * w[0] + M[2] * w[1] * w[1]) + M[1] * w[0] * w[1];
  e.elastic = rod_.energy(view.rod.stretch);
  e.tool = struck_.energy(striker(view_), tool(view_));
  e.rod = view_[kRodLoss];
  e.blow = view_[kBlowLoss] + view_put_back_;
  return e;
}

void ElasticMachine::followBlow() {
  BlowTruth* begun =
      follower_.follow({time_, now_[kCrankSpeed], now_[kRockerSpeed], striker(now_).speed, now_[kToolImpulse],
                        now_[kToolEnergy], now_[kRetainerImpulse], StruckTool::touches(contacts_)});
  if (!begun) return;
  begun->turn_period = time_ - current_.start;
  begun->turn_peak_force_z = current_.peak;
  begun->turn_impulse_x = now_[kImpulseX] - current_.impulse_x;
  begun->turn_impulse_z = now_[kImpulseZ] - current_.impulse_z;
  begun->whole_turn = current_.whole;
  current_ = {time_, now_[kImpulseX], now_[kImpulseZ], slope_[kImpulseZ], true};
}

/// Resets the tool, as the hull follows or the tool slides back. Its remaining energy is counted as lost in the blow.
void ElasticMachine::putToolBack() {
  const auto energy = [this] { return struck_.energy(striker(now_), tool(now_)); };
  const double before = energy();
  struck_.newTurn(time_);
  now_[kToolWay] = now_[kToolSpeed] = now_[kYielded] = 0.0;
  put_back_ += before - energy();
  contacts_ = contacts(now_);
  rate(now_, slope_, time_);
}

}  // namespace hammer_loads::simulation
