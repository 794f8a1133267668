// Integration in time: steps, the dead centre between them, stops and releases.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/simulation/drive.h"
#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {

HammerOnBoom::State HammerOnBoom::stepped(const State& s, double dt) const {
  struct Rate {
    Coordinates x, v;
    double p;
    ToolState tool;
    double impulse, energy, retainer;
    Eigen::Vector3d leak, shear;
  };
  const DriveSettings& d = machine_.drive;
  const Hold middle = elastic_ ? holdBetween(s.time + 0.5 * dt) : holdAt(s.time + 0.5 * dt),
             end = elastic_ ? holdBetween(s.time + dt) : holdAt(s.time + dt),
             begin = elastic_ ? holdBetween(s.time) : hold_;
  const auto rate = [&](const State& at, const Hold& hold) {
    const double flow = supplyFlow(d, at.time), valves = valveFlow(d, at.time, at.pressure);
    const double pressing = (flow - d.motor_displacement * at.v[3] - valves) / d.compliance;
    Rate r{at.v, acceleration(at, hold), pressing, {}, 0.0, 0.0, 0.0, leak(at, hold), shear(at)};
    if (!elastic_) return r;
    const StruckTool::Answer answer = struck(at);
    r.tool = answer.rate;
    r.impulse = answer.tool, r.energy = answer.tool * striker(at).speed, r.retainer = answer.retainer;
    return r;
  };
  const auto moved = [&](const Rate& r, double by) {
    State to = s;
    to.time += by, to.x += by * r.x, to.v += by * r.v, to.pressure += by * r.p, to.leaked += by * r.leak;
    to.sheared += by * r.shear;
    to.tool.way += by * r.tool.way, to.tool.speed += by * r.tool.speed, to.tool.yielded += by * r.tool.yielded;
    to.tool_impulse += by * r.impulse, to.tool_energy += by * r.energy, to.retainer_impulse += by * r.retainer;
    return to;
  };
  const Rate k1 = rate(s, begin), k2 = rate(moved(k1, 0.5 * dt), middle), k3 = rate(moved(k2, 0.5 * dt), middle),
             k4 = rate(moved(k3, dt), end);
  const auto mean = [](double a, double b, double c, double e) { return (a + 2.0 * (b + c) + e) / 6.0; };
  Rate all;
  all.x = (k1.x + 2.0 * (k2.x + k3.x) + k4.x) / 6.0, all.v = (k1.v + 2.0 * (k2.v + k3.v) + k4.v) / 6.0;
  all.leak = (k1.leak + 2.0 * (k2.leak + k3.leak) + k4.leak) / 6.0;
  all.shear = (k1.shear + 2.0 * (k2.shear + k3.shear) + k4.shear) / 6.0;
  all.p = mean(k1.p, k2.p, k3.p, k4.p);
  all.tool = {mean(k1.tool.way, k2.tool.way, k3.tool.way, k4.tool.way),
              mean(k1.tool.speed, k2.tool.speed, k3.tool.speed, k4.tool.speed),
              mean(k1.tool.yielded, k2.tool.yielded, k3.tool.yielded, k4.tool.yielded)};
  all.impulse = mean(k1.impulse, k2.impulse, k3.impulse, k4.impulse);
  all.energy = mean(k1.energy, k2.energy, k3.energy, k4.energy);
  all.retainer = mean(k1.retainer, k2.retainer, k3.retainer, k4.retainer);
  return moved(all, dt);
}

/// Part of the step dt, which passes the dead centre, until it is there: Newton.
double HammerOnBoom::timeToDeadCentre(double dt) const {
  double t = dt;
  for (int i = 0; i < 20; ++i) {
    const State at = stepped(now_, t);
    if (std::abs(at.x[3]) < 1e-14 || at.v[3] == 0.0) break;
    t = std::clamp(t - at.x[3] / at.v[3], 0.0, dt);
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
    const bool meets = now_.before_blow ? next.x[3] > 0.0 : next.x[3] < 0.0;
    if (meets) {
      dt = timeToDeadCentre(dt);
      next = stepped(now_, dt);
      next.x[3] = 0.0;
    }
    if (dt == left) next.time = time;
    now_ = next;
    if (now_.v[3] < 0.0) whole_turn_ = false;
    if (meets) {
      passDeadCentre();
    } else if (!now_.before_blow && now_.x[3] > kPi) {
      now_.x[3] -= 2.0 * kPi, now_.before_blow = true;
    } else if (now_.before_blow && now_.x[3] < -kPi) {
      now_.x[3] += 2.0 * kPi, now_.before_blow = false;
    }
  }
}

/// Once per instant: a torque that falls through zero lets go of the crank and stops it at once.
void HammerOnBoom::release() {
  if (!now_.resting || released_ >= now_.time) return;
  State free = now_;
  free.resting = false;
  if (!(acceleration(free, holdAt(now_.time))[3] > 0.0)) return;
  now_ = free;
  released_ = now_.time;
}

/// Forward a blow, backward a stop on the tool.
void HammerOnBoom::passDeadCentre() {
  if (now_.before_blow) {
    blow();
    return;
  }
  const Coordinates by_brake = massMatrix(bodies(now_)).ldlt().solve(Coordinates::Unit(3));
  now_.v -= by_brake * (now_.v[3] / by_brake[3]);
  now_.v[3] = 0.0;
  now_.resting = true;
  whole_turn_ = false;
}

std::vector<BlowTruth> HammerOnBoom::takeBlows() { return elastic_ ? follower_.take() : std::exchange(blows_, {}); }

}  // namespace hammer_loads::simulation
