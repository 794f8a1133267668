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
    foot.speed += foot.lift[j] * s.v[j] - along(-kI * (held_place - turnPlace(held, k))) * held.v[j];
  }
  return foot;
}

/// Deflection of the oil of all cylinders and of the rock by the hold-down force.
double HammerOnBoom::rockHeight(const Hold& hold) const {
  const RockSettings& rock = machine_.on_boom.rock;
  if (rock.stiffness == 0.0) return 0.0;
  const Eigen::Vector3d lift = foot(hold.state, hold.state).lift.head<3>();
  return rock.hold_down_force * (1.0 / rock.stiffness + lift.cwiseAbs2().cwiseQuotient(hold.stiffness).sum());
}

/// At the start, at rest, with steps that are short enough for the rock.
void HammerOnBoom::standOnRock() {
  const RockSettings& rock = machine_.on_boom.rock;
  if (rock.stiffness == 0.0) return;
  const Eigen::Vector3d lift = foot(hold_.state, hold_.state).lift.head<3>();
  now_.x.head<3>() += rock.hold_down_force * lift.cwiseQuotient(hold_.stiffness);
  const Eigen::Matrix3d M = massMatrix(heldBodies(hold_.state)).topLeftCorner<3, 3>();
  const double mass = 1.0 / lift.dot(M.ldlt().solve(lift));
  step_ = std::min(step_, kTwoPi * std::sqrt(mass / rock.stiffness) / kStepsPerSwing);
}

/// Force of the rock, continuous at the contact and never pulling.
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

}  // namespace hammer_loads::simulation
