#include <Eigen/Cholesky>
#include <cmath>

#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {

/// At the dead centre crank and rocker are free of each other: a coordinate more, which the linkage takes back.
void HammerOnBoom::blow() {
  const double u_before = links_.rockerAngle({0.0, true, false}).first;
  const double u_after = links_.rockerAngle({0.0, false, false}).first;
  const std::array<Body, 4> all = bodies(now_).body;
  Inertia M = rotorInertia();
  for (std::size_t k = 0; k < 4; ++k) {
    const Body& b = all[k];
    Coordinates x = b.x, z = b.z, turn = b.turn;
    x[3] = z[3] = turn[3] = 0.0;
    if (k == 3) x[4] = b.x[3] / u_before, z[4] = b.z[3] / u_before, turn[4] = 1.0;
    M += b.mass * (x * x.transpose() + z * z.transpose()) + b.inertia * turn * turn.transpose();
  }
  const PlanePoint to_hull = std::conj(turnedBy(hullAngle(now_)));
  const PlanePoint striker = jointPlace(now_, 3) - machine_.hammer.striking_distance / to_hull;
  Coordinates J = Coordinates::Zero(), v = now_.v, loop = J;  // of the striking point along the tool; no speed along
                                                              // the loop is left by the linkage
  for (std::size_t j = 0; j < turns(); ++j) J[turnIndex(j)] = (to_hull * -kI * (striker - turnPlace(now_, j))).imag();
  J[4] = machine_.hammer.striking_distance;
  v[4] = u_before * now_.v[3];
  loop[3] = u_after, loop[4] = -1.0;
  const Eigen::LDLT<Inertia> inverse = M.ldlt();
  const Coordinates by_tool = inverse.solve(J), by_loop = inverse.solve(loop);
  const BlowSettings& b = machine_.blow;
  const double restitution = b.restitution_low + draws_.uniform() * (b.restitution_high - b.restitution_low);
  const double P =
      b.restitution_drawn ? -(1.0 + restitution) * J.dot(v) / J.dot(by_tool) : -loop.dot(v) / loop.dot(by_tool);
  const Coordinates left = v + P * by_tool, after = left - by_loop * (loop.dot(left) / loop.dot(by_loop));

  BlowTruth truth;
  truth.time = now_.time;
  truth.crank_speed = v[3];
  truth.strike = {v[4], left[4],  -P * 0.5 * J.dot(v + left),
                  P,    after[3], 0.5 * (left.dot(M * left) - after.dot(M * after))};
  truth.turn_period = now_.time - last_blow_;
  truth.turn_peak_force_z = truth.turn_impulse_x = truth.turn_impulse_z = truth.last_lobe_impulse_z = kNaN;
  truth.whole_turn = whole_turn_;
  blows_.push_back(truth);
  now_.v = after;
  now_.v[4] = 0.0;
  now_.before_blow = false;
  last_blow_ = now_.time;
  whole_turn_ = true;
  ++turn_;
}

}  // namespace hammer_loads::simulation
