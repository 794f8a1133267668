#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kStepsPerSwing = 60.0;  // steps per oscillation of the hull on the rock's spring

}  // namespace

PlanePoint HammerOnBoom::footPlace(const State& s) const {
  return jointPlace(s, 3) + turnedBy(hullAngle(s)) * boom_.foot;
}

/// The rock's face is normal to the tool at the operator's pose and moves with it.
HammerOnBoom::Foot HammerOnBoom::foot(const State& s, const State& held) const {
  const PlanePoint up = kI * turnedBy(hullAngle(held));
  const auto along = [&](PlanePoint p) { return (p * std::conj(up)).real(); };
  const PlanePoint place = footPlace(s), held_place = footPlace(held);
  Foot foot;
  foot.height = along(place - held_place);
  foot.lift.setZero();
  for (std::size_t k = 0; k < turns(); ++k) {
    const int j = turnIndex(k);
    foot.lift[j] = along(-kI * (place - turnPlace(s, k)));
    foot.speed += foot.lift[j] * s.v()[j] - along(-kI * (held_place - turnPlace(held, k))) * held.v()[j];
  }
  return foot;
}

/// Returns the deflection of rock and oil of all cylinders by the hold-down force.
double HammerOnBoom::rockHeight(const Hold& hold) const {
  const RockSettings& rock = machine_.on_boom.rock;
  if (rock.stiffness == 0.0) return 0.0;
  const Eigen::Vector3d lift = foot(hold.state, hold.state).lift.head<3>();
  return rock.hold_down_force * (1.0 / rock.stiffness + lift.cwiseAbs2().cwiseQuotient(hold.stiffness).sum());
}

/// Initializes the hull at rest on the rock, with steps that are short enough for the rock.
void HammerOnBoom::standOnRock() {
  const RockSettings& rock = machine_.on_boom.rock;
  if (rock.stiffness == 0.0) return;
  const Eigen::Vector3d lift = foot(hold_.state, hold_.state).lift.head<3>();
  now_.x().head<3>() += rock.hold_down_force * lift.cwiseQuotient(hold_.stiffness);
  const Eigen::Matrix3d M = massMatrix(heldBodies(hold_.state)).topLeftCorner<3, 3>();
  const double mass = 1.0 / lift.dot(M.ldlt().solve(lift));
  step_ = std::min(step_, kTwoPi * std::sqrt(mass / rock.stiffness) / kStepsPerSwing);
}

/// Returns the force of the rock, which is continuous at the contact and never pulls.
double HammerOnBoom::rockForce(const Foot& foot) const {
  const RockSettings& rock = machine_.on_boom.rock;
  const double depth = rock_height_ - foot.height;
  return rock.stiffness * std::max(0.0, depth) * std::max(0.0, 1.0 - rock.damping * foot.speed);
}

Load HammerOnBoom::rockLoad(const State& held) const {
  if (machine_.on_boom.rock.stiffness == 0.0) return {};
  const double turned = hullAngle(now_) - hullAngle(held);  // rotation of the hull against the rock's face
  const PlanePoint force = rockForce(foot(now_, held)) * kI * std::conj(turnedBy(turned));
  const PlanePoint r = boom_.foot;
  return {force.real(), force.imag(), r.imag() * force.real() - r.real() * force.imag()};
}

/// At the dead centre crank and rocker move independently of each other. This adds a coordinate, which the linkage
/// removes again after the blow.
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
  Coordinates J = Coordinates::Zero(), v = now_.v(), loop = J;  // J: of the striking point along the tool; loop: the
                                                                // linkage permits no speed along it
  for (std::size_t j = 0; j < turns(); ++j) J[turnIndex(j)] = (to_hull * -kI * (striker - turnPlace(now_, j))).imag();
  J[4] = machine_.hammer.striking_distance;
  v[4] = u_before * now_.v()[3];
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
  endTurn(truth);
  blows_.push_back(truth);
  now_.v() = after;
  now_.v()[4] = 0.0;
  now_.before_blow = false;
  ++turn_;
}

/// Ends the revolution at a blow that begins now.
void HammerOnBoom::endTurn(BlowTruth& blow) {
  blow.turn_period = now_.time - last_blow_;
  blow.turn_peak_force_z = blow.turn_impulse_x = blow.turn_impulse_z = kNaN;
  blow.whole_turn = whole_turn_;
  last_blow_ = now_.time;
  whole_turn_ = true;
}

}  // namespace hammer_loads::simulation
