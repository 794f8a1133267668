#include "hammer_loads/simulation/hammer_on_boom.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hammer_loads/simulation/drive.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kFastRod = 0.15;  // speed of a fast cylinder rod [m/s]

/// Transforms a vector from the axes of the mechanism frame to those of the hull, by a reflection.
PlanePoint inHull(double xi, double eta, double com_angle) {
  const double c = std::cos(com_angle), s = std::sin(com_angle);
  return {-(c * xi + s * eta), -s * xi + c * eta};
}

using Modes = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d>;

Modes modesOf(const Eigen::Vector3d& K, const Eigen::Matrix3d& M) { return Modes(K.asDiagonal(), M); }

}  // namespace

HammerOnBoom::HammerOnBoom(const MachineSettings& machine, const OilBoom& boom)
    : machine_(machine),
      boom_(boom),
      links_(mechanismFrom(machine.hammer), Level::kRocker),
      rotor_(machine.drive.inertia),
      ratio_(machine.hammer.drive_reaction_ratio),
      draws_(machine.seed ^ kBlowSeed) {
  if (machine.rod.stiffness > 0.0)
    elastic_.emplace(Elastic{{machine.hammer, Level::kRocker}, RodSpring(machine.rod), {machine}});
  boom_.bulk_modulus *= machine.on_boom.oil_stiffness;
  takeMovingPartsOffTheHull();
  now_ = heldAt(0.0);
  held_rocker_ = rockerAt(now_);
  now_.v()[3] = now_.v()[4] = 0.0;
  stiffenLinks();
  now_.before_blow = machine.start_angle > kPi;
  now_.x()[3] = now_.before_blow ? machine.start_angle - 2.0 * kPi : machine.start_angle;
  now_.x()[4] = rockerOf(machine.start_angle);
  step_ = machine_.on_boom.step;
  if (const double presliding = machine_.on_boom.seals.presliding; presliding > 0.0)
    step_ = std::min(step_, presliding / kFastRod);
  followOperator();
  standOnRock();
}

/// Sets the stiffnesses of the links such that each bend alone has its frequency at the initial pose.
void HammerOnBoom::stiffenLinks() {
  if (!bends()) return;
  const double omega = kTwoPi * machine_.on_boom.bending_frequency;
  const Eigen::Vector2d inertia = massMatrix(heldBodies(now_)).diagonal().tail<2>();
  link_stiffness_ = omega * omega * inertia;
  link_damping_ = 2.0 * machine_.on_boom.bending_damping * omega * inertia;
}

/// Subtracts rotor and rocker from the hull of the description, which contains the rocker averaged over a revolution.
void HammerOnBoom::takeMovingPartsOffTheHull() {
  constexpr int kPlaces = 360;
  State held = heldAt(0.0);
  const PlanePoint joint = jointPlace(held, 2), to_hull = std::conj(turnedBy(hullAngle(held)));
  double mass = 0.0, square = 0.0;  // square: mean square distance from the joint
  PlanePoint at = 0.0;
  double inertia = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    held.x()[3] = (i + 0.5) * kTwoPi / kPlaces - kPi;
    held.before_blow = held.x()[3] < 0.0;
    held.x()[4] = rockerOf(held.before_blow ? held.x()[3] + kTwoPi : held.x()[3]);
    const Body rocker = bodies(held).body[3];
    const PlanePoint place = (rocker.place - joint) * to_hull;
    mass = rocker.mass, inertia = rocker.inertia;
    at += place / static_cast<double>(kPlaces), square += std::norm(place) / kPlaces;
  }
  OilBoomLink& hull = boom_.links[2];
  const double about_joint = hull.inertia + hull.mass * std::norm(hull.com);
  const PlanePoint com = (hull.mass * hull.com - mass * at) / (hull.mass - mass);
  hull.mass -= mass;
  hull.com = com;
  hull.inertia = about_joint - mass * square - inertia - rotor_ * ratio_ * ratio_ - hull.mass * std::norm(com);
}

/// Updates pose and damping, so that every mode keeps its damping ratio in any pose of the boom.
void HammerOnBoom::followOperator() {
  hold_ = holdAt(now_.time);
  const Eigen::Matrix3d M = massMatrix(heldBodies(hold_.state)).topLeftCorner<3, 3>();
  const Modes modes = modesOf(hold_.stiffness, M);
  const Eigen::Vector3d rates = 2.0 * machine_.on_boom.damping * modes.eigenvalues().cwiseSqrt();
  const Eigen::Matrix3d inertia = M * modes.eigenvectors();
  damping_ = inertia * rates.asDiagonal() * inertia.transpose();
  rock_height_ = rockHeight(hold_);
}

Eigen::Vector3d HammerOnBoom::frequencies(double time) const {
  const State held = heldAt(time);
  const Eigen::Matrix3d M = massMatrix(heldBodies(held)).topLeftCorner<3, 3>();
  return modesOf(holdAt(time).stiffness, M).eigenvalues().cwiseSqrt() / kTwoPi;
}

/// Returns the state in which the operator holds the joints, with the crank a quarter of a revolution from the blow.
HammerOnBoom::State HammerOnBoom::heldAt(double time) const {
  State s;
  s.time = time;
  s.x().tail<2>().setZero(), s.v().tail<2>().setZero();
  for (int k = 0; k < 3; ++k) {
    const JointMotion& joint = machine_.boom[static_cast<std::size_t>(k + 1)];
    s.x()[k] = positionOf(joint, time), s.v()[k] = velocityOf(joint, time);
  }
  s.x()[3] = 0.5 * kPi, s.v()[3] = 0.0;
  s.x()[4] = rockerOf(s.x()[3]), s.v()[4] = 0.0;
  return s;
}

HammerOnBoom::Hold HammerOnBoom::holdAt(double time) const {
  const State held = heldAt(time);
  const Coordinates all = weight(heldBodies(held));
  const Eigen::Vector3d down = all.head<3>();
  return {held, down, stiffness(held, down), all.tail<2>()};
}

double HammerOnBoom::angleBefore(const State& s, std::size_t joint) {
  double angle = 0.0;
  for (std::size_t k = 0; k < joint; ++k) angle += s.x()[static_cast<int>(k)];
  for (std::size_t k = 0; k + 1 < joint; ++k) angle += s.x()[5 + static_cast<int>(k)];
  return angle;
}

PlanePoint HammerOnBoom::jointPlace(const State& s, std::size_t joint) const {
  PlanePoint place = 0.0;
  for (std::size_t k = 0; k < joint; ++k) {
    const PlanePoint middle = middleOf(k);
    place += turnedBy(angleBefore(s, k + 1)) * middle + turnedBy(bentAngle(s, k)) * (boom_.links[k].to_next - middle);
  }
  return place;
}

PlanePoint HammerOnBoom::turnPlace(const State& s, std::size_t turn) const {
  if (turn < 3) return jointPlace(s, turn);
  return jointPlace(s, turn - 3) + turnedBy(angleBefore(s, turn - 2)) * middleOf(turn - 3);
}

HammerOnBoom::Bodies HammerOnBoom::bodies(const State& s, const Links& links, const Rocker& rocker) const {
  Bodies all;
  all.joint[0] = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const OilBoomLink& link = links[k];
    all.angle[k] = (k == 0 ? 0.0 : bentAngle(s, k - 1)) + s.x()[static_cast<int>(k)];
    const PlanePoint turned = all.hull_turned = turnedBy(all.angle[k]);
    const PlanePoint middle = all.joint[k] + turned * middleOf(k);
    if (k < 2) all.middle[k] = middle;
    const PlanePoint beyond = k < 2 && bends() ? turnedBy(bentAngle(s, k)) : turned;
    all.joint[k + 1] = middle + beyond * (link.to_next - middleOf(k));
    Body& body = all.body[k];
    body.mass = link.mass, body.inertia = link.inertia;
    body.place = all.joint[k] + turned * link.com;
    body.x.setZero(), body.z.setZero(), body.turn.setZero();
    turnAbout(all, body, k + 1);
  }
  const HammerParameters& p = machine_.hammer;
  Body& r = all.body[3];
  r.mass = rocker.mass, r.inertia = rocker.inertia_about_com;
  r.place = all.joint[3] +
            all.hull_turned * inHull(rocker.xi.value - p.lengths.pivot_distance, rocker.eta.value, p.rocker_com_angle);
  r.x.setZero(), r.z.setZero(), r.turn.setZero();
  turnAbout(all, r, 3);
  const PlanePoint by_crank = all.hull_turned * inHull(rocker.xi.first, rocker.eta.first, p.rocker_com_angle);
  const int k = rockerIndex();
  r.x[k] = by_crank.real(), r.z[k] = by_crank.imag(), r.turn[k] = rocker.angle.first;
  return all;
}

/// Sets the derivatives of a body's position and angle by the first joints and by the bends between them.
void HammerOnBoom::turnAbout(const Bodies& all, Body& body, std::size_t joints) const {
  const auto turn = [&](int i, PlanePoint about) {
    const PlanePoint arm = body.place - about;
    body.x[i] = arm.imag(), body.z[i] = -arm.real(), body.turn[i] = 1.0;
  };
  for (std::size_t j = 0; j < joints; ++j) {
    turn(static_cast<int>(j), all.joint[j]);
    if (bends() && j + 1 < joints) turn(5 + static_cast<int>(j), all.middle[j]);
  }
}

/// Returns the inertia of the rotor. The elements of rigid links are 1, so that the matrix is invertible.
HammerOnBoom::Inertia HammerOnBoom::rotorInertia() const {
  Coordinates rotor;
  const double bent = bends() ? ratio_ : 0.0;
  rotor << ratio_, ratio_, ratio_, 1.0, 0.0, bent, bent;
  Inertia M = rotor_ * rotor * rotor.transpose();
  if (!bends()) M(5, 5) = M(6, 6) = 1.0;
  return M;
}

HammerOnBoom::Inertia HammerOnBoom::massMatrix(const Bodies& all) const {
  Inertia M = rotorInertia();
  for (const Body& b : all.body)
    M += b.mass * (b.x * b.x.transpose() + b.z * b.z.transpose()) + b.inertia * b.turn * b.turn.transpose();
  if (!elastic_) M(4, 4) = 1.0;
  return M;
}

HammerOnBoom::Coordinates HammerOnBoom::weight(const Bodies& all) const {
  Coordinates Q = Coordinates::Zero();
  for (const Body& b : all.body) Q -= b.mass * machine_.gravity * b.z;
  return Q;
}

/// Returns all forces except inertia: weight, cylinders, rock, bending, motor, rod and contact.
HammerOnBoom::Coordinates HammerOnBoom::force(const State& s, const Bodies& all, const Hold& hold) const {
  Coordinates Q = weight(all);
  Q.head<3>() += holding(s, hold);
  if (machine_.on_boom.rock.stiffness > 0.0) {
    const Foot at = foot(s, hold.state);
    Q += rockForce(at) * at.lift;
  }
  if (bends())
    Q.tail<2>() -=
        hold.bent + link_stiffness_.cwiseProduct(s.x().tail<2>()) + link_damping_.cwiseProduct(s.v().tail<2>());
  Q[3] += netTorque(machine_.drive, s.y[kPressure], s.v()[3]);
  if (elastic_) Q += elasticForce(s);
  return Q;
}

/// Returns the inertia terms of the bodies that depend on speeds alone: centripetal ones, and those of the rocker
/// within a rotating hull.
HammerOnBoom::Coordinates HammerOnBoom::inertiaOfSpeeds(const State& s, const Bodies& all, const Rocker& rocker) const {
  Coordinates Q = Coordinates::Zero();
  PlanePoint of_joint = 0.0;  // acceleration of the joint
  double rate = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Body& link = all.body[k];
    rate += s.v()[static_cast<int>(k)];
    const PlanePoint a = of_joint - rate * rate * (link.place - all.joint[k]);
    Q += link.mass * (a.real() * link.x + a.imag() * link.z);
    const int bend = 5 + static_cast<int>(k);
    if (k < 2) of_joint -= rate * rate * (all.middle[k] - all.joint[k]), rate += s.v()[bend];
    of_joint -= rate * rate * (all.joint[k + 1] - (k < 2 ? all.middle[k] : all.joint[k]));
  }
  const Body& r = all.body[3];
  const int k = rockerIndex();
  const double w = s.v()[k];
  const PlanePoint by_crank(r.x[k], r.z[k]),
      bend = all.hull_turned * inHull(rocker.xi.second, rocker.eta.second, machine_.hammer.rocker_com_angle);
  const PlanePoint a =
      of_joint - rate * rate * (r.place - all.joint[3]) - 2.0 * rate * w * kI * by_crank + w * w * bend;
  return Q + r.mass * (a.real() * r.x + a.imag() * r.z) + r.inertia * rocker.angle.second * w * w * r.turn;
}

HammerOnBoom::Coordinates HammerOnBoom::acceleration(const State& s, const Hold& hold) const {
  const Rocker rocker = rockerAt(s);
  const Bodies all = bodies(s, boom_.links, rocker);
  Inertia M = massMatrix(all);
  Coordinates Q = force(s, all, hold) - inertiaOfSpeeds(s, all, rocker);
  if (s.resting) {
    M.row(3).setZero(), M.col(3).setZero();
    M(3, 3) = 1.0, Q[3] = 0.0;
  }
  if (bends()) return M.ldlt().solve(Q);
  Coordinates a = Coordinates::Zero();
  a.head<5>() = M.topLeftCorner<5, 5>().ldlt().solve(Q.head<5>());
  return a;
}

}  // namespace hammer_loads::simulation
