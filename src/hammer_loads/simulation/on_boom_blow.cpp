#include <Eigen/Cholesky>
#include <cmath>

#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {

/// At the dead centre crank and rocker are free of each other: five coordinates, of which the linkage makes four again.
void HammerOnBoom::blow() {
  using Vector5 = Eigen::Matrix<double, 5, 1>;
  using Matrix5 = Eigen::Matrix<double, 5, 5>;
  const double u_before = links_.rockerAngle({0.0, true, false}).first;
  const double u_after = links_.rockerAngle({0.0, false, false}).first;
  const std::array<Body, 4> all = bodies(now_).body;
  Vector5 rotor;
  rotor << ratio_, ratio_, ratio_, 1.0, 0.0;
  Matrix5 M = rotor_ * rotor * rotor.transpose();
  for (std::size_t k = 0; k < 4; ++k) {
    Vector5 x = Vector5::Zero(), z = x, turn = x;
    const Body& b = all[k];
    x.head<3>() = b.x.head<3>(), z.head<3>() = b.z.head<3>(), turn.head<3>() = b.turn.head<3>();
    if (k == 3) x[4] = b.x[3] / u_before, z[4] = b.z[3] / u_before, turn[4] = 1.0;
    M += b.mass * (x * x.transpose() + z * z.transpose()) + b.inertia * turn * turn.transpose();
  }
  const PlanePoint to_hull = std::conj(turnedBy(hullAngle(now_)));
  const PlanePoint striker = jointPlace(now_, 3) - machine_.hammer.striking_distance / to_hull;
  Vector5 J, v, loop;  // of the striking point along the tool; the linkage allows no speed along the loop
  for (std::size_t j = 0; j < 3; ++j) J[static_cast<int>(j)] = (to_hull * -kI * (striker - jointPlace(now_, j))).imag();
  J[3] = 0.0, J[4] = machine_.hammer.striking_distance;
  v << now_.v.head<4>(), u_before * now_.v[3];
  loop << 0.0, 0.0, 0.0, u_after, -1.0;
  const Eigen::LDLT<Matrix5> inverse = M.ldlt();
  const Vector5 by_tool = inverse.solve(J), by_loop = inverse.solve(loop);
  const BlowSettings& b = machine_.blow;
  const double restitution = b.restitution_low + draws_.uniform() * (b.restitution_high - b.restitution_low);
  const double P =
      b.restitution_drawn ? -(1.0 + restitution) * J.dot(v) / J.dot(by_tool) : -loop.dot(v) / loop.dot(by_tool);
  const Vector5 left = v + P * by_tool, after = left - by_loop * (loop.dot(left) / loop.dot(by_loop));

  BlowTruth truth;
  truth.time = now_.time;
  truth.crank_speed = v[3];
  truth.strike = {v[4], left[4],  -P * 0.5 * J.dot(v + left),
                  P,    after[3], 0.5 * (left.dot(M * left) - after.dot(M * after))};
  truth.turn_period = now_.time - last_blow_;
  truth.turn_peak_force_z = truth.turn_impulse_x = truth.turn_impulse_z = truth.last_lobe_impulse_z = kNaN;
  truth.whole_turn = whole_turn_;
  blows_.push_back(truth);
  now_.v.head<4>() = after.head<4>();
  now_.before_blow = false;
  last_blow_ = now_.time;
  whole_turn_ = true;
  ++turn_;
}

}  // namespace hammer_loads::simulation
