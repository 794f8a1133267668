// Integration in time: steps, the dead centre between them, stops and releases.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/simulation/drive.h"
#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {

HammerOnBoom::Vector HammerOnBoom::rate(const State& s, const Hold& hold) const {
  const DriveSettings& d = machine_.drive;
  const double pressure = s.y[kPressure];
  Vector r = Vector::Zero();
  r.head<7>() = s.v();
  r.segment<7>(7) = acceleration(s, hold);
  r[kPressure] =
      (supplyFlow(d, s.time) - d.motor_displacement * s.v()[3] - valveFlow(d, s.time, pressure)) / d.compliance;
  r.segment<3>(kLeaked) = leak(s, hold);
  r.segment<3>(kSheared) = shear(s);
  if (!elastic_) return r;
  const StruckTool::Answer answer = struck(s);
  r[kTool] = answer.rate.way, r[kTool + 1] = answer.rate.speed, r[kTool + 2] = answer.rate.yielded;
  r[kToolImpulse] = answer.tool, r[kToolEnergy] = answer.tool * striker(s).speed;
  r[kRetainerImpulse] = answer.retainer;
  return r;
}

HammerOnBoom::State HammerOnBoom::stepped(const State& s, double dt) const {
  const Hold middle = elastic_ ? holdBetween(s.time + 0.5 * dt) : holdAt(s.time + 0.5 * dt),
             end = elastic_ ? holdBetween(s.time + dt) : holdAt(s.time + dt),
             begin = elastic_ ? holdBetween(s.time) : hold_;
  const auto moved = [&](const Vector& slope, double by) {
    State to = s;
    to.time += by, to.y += by * slope;
    return to;
  };
  const Vector k1 = rate(s, begin), k2 = rate(moved(k1, 0.5 * dt), middle), k3 = rate(moved(k2, 0.5 * dt), middle),
               k4 = rate(moved(k3, dt), end);
  return moved((k1 + 2.0 * (k2 + k3) + k4) / 6.0, dt);
}

/// Returns the part of the step dt up to the dead centre, which the step passes, by Newton's method.
double HammerOnBoom::timeToDeadCentre(double dt) const {
  double t = dt;
  for (int i = 0; i < 20; ++i) {
    const State at = stepped(now_, t);
    if (std::abs(at.x()[3]) < 1e-14 || at.v()[3] == 0.0) break;
    t = std::clamp(t - at.x()[3] / at.v()[3], 0.0, dt);
  }
  return t;
}

void HammerOnBoom::advanceTo(double time) {
  if (elastic_) {
    advanceElastic(time);
    return;
  }
  while (now_.time < time) {
    release();
    followOperator();
    const double left = time - now_.time;
    double dt = std::min(step_, left);
    State next = stepped(now_, dt);
    const bool meets = now_.before_blow ? next.x()[3] > 0.0 : next.x()[3] < 0.0;
    if (meets) {
      dt = timeToDeadCentre(dt);
      next = stepped(now_, dt);
      next.x()[3] = 0.0;
    }
    if (dt == left) next.time = time;
    now_ = next;
    if (now_.v()[3] < 0.0) whole_turn_ = false;
    if (meets) {
      passDeadCentre();
    } else if (!now_.before_blow && now_.x()[3] > kPi) {
      now_.x()[3] -= 2.0 * kPi, now_.before_blow = true;
    } else if (now_.before_blow && now_.x()[3] < -kPi) {
      now_.x()[3] += 2.0 * kPi, now_.before_blow = false;
    }
  }
}

/// Releases the crank at most once per instant: a torque that falls through zero would stop it again at once.
void HammerOnBoom::release() {
  if (!now_.resting || released_ >= now_.time) return;
  State free = now_;
  free.resting = false;
  if (!(acceleration(free, holdAt(now_.time))[3] > 0.0)) return;
  now_ = free;
  released_ = now_.time;
}

/// Applies a blow when passed forwards and a stop on the tool when passed backwards.
void HammerOnBoom::passDeadCentre() {
  if (now_.before_blow) {
    blow();
    return;
  }
  const Coordinates by_brake = massMatrix(bodies(now_)).ldlt().solve(Coordinates::Unit(3));
  now_.v() -= by_brake * (now_.v()[3] / by_brake[3]);
  now_.v()[3] = 0.0;
  now_.resting = true;
  whole_turn_ = false;
}

std::vector<BlowTruth> HammerOnBoom::takeBlows() { return elastic_ ? follower_.take() : std::exchange(blows_, {}); }

}  // namespace hammer_loads::simulation
