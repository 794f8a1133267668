#include "hammer_loads/simulation/hammer_on_boom.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hammer_loads::simulation {
namespace {

constexpr double kPi = 3.141592653589793238;
const PlanePoint kI(0.0, 1.0);

double areaOf(double diameter) { return 0.25 * kPi * diameter * diameter; }

/// Moment about +y of a force at r.
double moment(PlanePoint r, PlanePoint f) { return r.imag() * f.real() - r.real() * f.imag(); }

/// From the mechanism frame with its origin at A to the hull's axes with theirs at D; a reflection.
PlanePoint inHull(double xi, double eta, double com_angle) {
  const double c = std::cos(com_angle), s = std::sin(com_angle);
  return {-(c * xi + s * eta), -s * xi + c * eta};
}

double rise(double time, double from, double length) {
  const double x = std::clamp((time - from) / length, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace

OilBoom oilBoomEo2621() {
  OilBoom b;
  const PlanePoint bracket(0.03, -0.06), hull(0.10 - 0.08, -0.55 + 0.05),
      both = (50.0 * bracket + 350.0 * hull) / 400.0;
  b.links[0] = {{2.60, 0.0}, {1.20, 0.08}, 400.0, 229.4};
  b.links[1] = {{1.70, 0.0}, {0.70, 0.06}, 230.0, 86.03};
  b.links[2] = {
      {0.10, -0.55}, both, 400.0, 1.104 + 29.9 + 50.0 * std::norm(bracket - both) + 350.0 * std::norm(hull - both)};
  const auto cylinder = [](PlanePoint base, PlanePoint rod, double bore, double rod_diameter, double closed,
                           double stroke, double hose) {
    return OilCylinder{base, rod, areaOf(bore), areaOf(bore) - areaOf(rod_diameter), closed, stroke, hose, hose};
  };
  const PlanePoint foot(0.25, 0.40);
  b.cylinders[0] = cylinder(PlanePoint(0.138, -0.159) - foot, {0.90, -0.10}, 0.110, 0.063, 0.79, 0.65, 0.0008);
  b.cylinders[1] =
      cylinder(PlanePoint(1.30, 0.30) - b.links[0].to_next, {-0.371, 0.197}, 0.100, 0.056, 1.00, 0.73, 0.0010);
  b.cylinders[2] =
      cylinder(PlanePoint(0.50, 0.28) - b.links[1].to_next, {0.277, 0.115}, 0.080, 0.050, 0.99, 0.53, 0.0012);
  b.pose = {-0.35, 1.20, -0.85};
  b.bulk_modulus = 1.0e9;
  b.damping = 0.05;
  b.cut = {1.10, 0.08};
  b.beyond_cut = {{}, {1.813, 0.08}, 208.2, 40.3};
  return b;
}

/// What the hull keeps of its mass is that of the description less rocker, at its mean place, and rotor.
HammerOnBoom::HammerOnBoom(const MachineSettings& machine, const OilBoom& boom)
    : machine_(machine),
      boom_(boom),
      links_(*Mechanism::make(machine.hammer).value, Level::kRocker),
      rotor_(machine.drive.inertia),
      ratio_(machine.hammer.drive_reaction_ratio) {
  now_.x.setZero(), now_.v.setZero();
  now_.before_blow = machine.start_angle > kPi;
  now_.x[3] = now_.before_blow ? machine.start_angle - 2.0 * kPi : machine.start_angle;
  State middle = now_;
  middle.before_blow = false, middle.x[3] = 0.5 * kPi;
  const Body rocker = bodies(middle)[3];
  OilBoomLink& hull = boom_.links[2];
  const PlanePoint at = (rocker.place - jointPlace(middle, 2)) * std::exp(kI * hullAngle(middle));
  const PlanePoint com = (hull.mass * hull.com - rocker.mass * at) / (hull.mass - rocker.mass);
  hull.inertia += hull.mass * std::norm(hull.com - com) - rocker.mass * std::norm(at - com) - rocker.inertia -
                  rotor_ * ratio_ * ratio_;
  hull.mass -= rocker.mass;
  hull.com = com;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const OilCylinder& c = boom_.cylinders[i];
    const double out = lengthOf(k, boom_.pose[i]) - c.closed_length, lever = arm(k, boom_.pose[i]);
    stiffness_[k] = boom_.bulk_modulus * lever * lever *
                    (c.bore_area * c.bore_area / (c.bore_hose + c.bore_area * out) +
                     c.rod_area * c.rod_area / (c.rod_hose + c.rod_area * (c.stroke - out)));
  }
  hold_ = -weight(middle).head<3>();
  const Eigen::Matrix3d M = massMatrix(middle).topLeftCorner<3, 3>(), K = stiffness_.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> modes(K, M);
  const Eigen::Vector3d rates = 2.0 * boom_.damping * modes.eigenvalues().cwiseSqrt();
  const Eigen::Matrix3d inertia = M * modes.eigenvectors();
  damping_ = inertia * rates.asDiagonal() * inertia.transpose();
}

double HammerOnBoom::lengthOf(int cylinder, double angle) const {
  const OilCylinder& c = boom_.cylinders[static_cast<std::size_t>(cylinder)];
  return std::abs(std::exp(-kI * angle) * c.rod - c.base);
}

double HammerOnBoom::arm(int cylinder, double angle) const {
  return (lengthOf(cylinder, angle + 1e-5) - lengthOf(cylinder, angle - 1e-5)) / 2e-5;
}

double HammerOnBoom::hullAngle(const State& s) const {
  return boom_.pose[0] + boom_.pose[1] + boom_.pose[2] + s.x.head<3>().sum();
}

PlanePoint HammerOnBoom::jointPlace(const State& s, int joint) const {
  PlanePoint place = 0.0;
  double angle = 0.0;
  for (int k = 0; k < joint; ++k) {
    const auto i = static_cast<std::size_t>(k);
    angle += boom_.pose[i] + s.x[k];
    place += std::exp(-kI * angle) * boom_.links[i].to_next;
  }
  return place;
}

HammerOnBoom::Bodies HammerOnBoom::bodies(const State& s) const {
  Bodies all;
  std::array<PlanePoint, 4> joint;
  double angle = 0.0;
  joint[0] = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const OilBoomLink& link = boom_.links[k];
    angle += boom_.pose[k] + s.x[static_cast<int>(k)];
    const PlanePoint turned = std::exp(-kI * angle);
    joint[k + 1] = joint[k] + turned * link.to_next;
    all[k].mass = link.mass, all[k].inertia = link.inertia;
    all[k].place = joint[k] + turned * link.com;
  }
  const LinkBodies::Body rocker = links_.at({s.x[3], s.before_blow, false}).body[0];
  const HammerParameters& p = machine_.hammer;
  const PlanePoint turned = std::exp(-kI * angle);
  Body& r = all[3];
  r.mass = rocker.mass, r.inertia = rocker.inertia_about_com;
  r.place =
      joint[3] + turned * inHull(rocker.xi.value - p.lengths.pivot_distance, rocker.eta.value, p.rocker_com_angle);
  r.by[3] = turned * inHull(rocker.xi.first, rocker.eta.first, p.rocker_com_angle);
  for (std::size_t k = 0; k < 4; ++k) {
    all[k].turn.setZero();
    for (std::size_t j = 0; j < 3; ++j) {
      const bool moves = j <= k;
      all[k].by[j] = moves ? -kI * (all[k].place - joint[j]) : 0.0;
      all[k].turn[static_cast<int>(j)] = moves ? 1.0 : 0.0;
    }
  }
  r.turn[3] = rocker.angle.first;
  return all;
}

HammerOnBoom::Matrix4 HammerOnBoom::massMatrix(const State& s) const {
  const Vector4 rotor(ratio_, ratio_, ratio_, 1.0);
  Matrix4 M = rotor_ * rotor * rotor.transpose();
  for (const Body& b : bodies(s)) {
    Vector4 x, z;
    for (int k = 0; k < 4; ++k)
      x[k] = b.by[static_cast<std::size_t>(k)].real(), z[k] = b.by[static_cast<std::size_t>(k)].imag();
    M += b.mass * (x * x.transpose() + z * z.transpose()) + b.inertia * b.turn * b.turn.transpose();
  }
  return M;
}

HammerOnBoom::Vector4 HammerOnBoom::weight(const State& s) const {
  Vector4 Q = Vector4::Zero();
  for (const Body& b : bodies(s)) {
    for (int k = 0; k < 4; ++k) Q[k] -= b.mass * machine_.gravity * b.by[static_cast<std::size_t>(k)].imag();
  }
  return Q;
}

Eigen::Vector3d HammerOnBoom::holding(const State& s) const {
  return hold_ - stiffness_.cwiseProduct(s.x.head<3>()) - damping_ * s.v.head<3>();
}

/// All that is not inertia: weight, oil, motor.
HammerOnBoom::Vector4 HammerOnBoom::force(const State& s, const Vector4& inertia) const {
  const DriveSettings& d = machine_.drive;
  Vector4 Q = weight(s) - inertia;
  Q.head<3>() += holding(s);
  Q[3] += d.motor_displacement * s.pressure - d.coulomb_friction * std::tanh(s.v[3] / d.friction_speed) -
          d.viscous_friction * s.v[3];
  return Q;
}

/// Lagrange: M a + (dM/dt) v - 1/2 d(v M v)/dx = Q.
HammerOnBoom::Vector4 HammerOnBoom::acceleration(const State& s) const {
  constexpr double h = 1e-5;
  Matrix4 rate = Matrix4::Zero();
  Vector4 energy_slope;
  for (int k = 0; k < 4; ++k) {
    State up = s, down = s;
    up.x[k] += h, down.x[k] -= h;
    const Matrix4 slope = (massMatrix(up) - massMatrix(down)) / (2.0 * h);
    rate += s.v[k] * slope;
    energy_slope[k] = 0.5 * s.v.dot(slope * s.v);
  }
  return massMatrix(s).ldlt().solve(force(s, rate * s.v - energy_slope));
}

double HammerOnBoom::pressureRate(const State& s) const {
  const DriveSettings& d = machine_.drive;
  const double flow = d.flow * rise(s.time, d.start_time, d.start_ramp);
  const double valves = d.leakage * s.pressure + d.relief_slope * std::max(0.0, s.pressure - d.relief_pressure);
  return (flow - d.motor_displacement * s.v[3] - valves) / d.compliance;
}

HammerOnBoom::State HammerOnBoom::stepped(const State& s, double dt) const {
  struct Rate {
    Vector4 x, v;
    double p;
  };
  const auto rate = [&](const State& at) { return Rate{at.v, acceleration(at), pressureRate(at)}; };
  const auto moved = [&](const Rate& r, double by) {
    State to = s;
    to.time += by, to.x += by * r.x, to.v += by * r.v, to.pressure += by * r.p;
    return to;
  };
  const Rate k1 = rate(s), k2 = rate(moved(k1, 0.5 * dt)), k3 = rate(moved(k2, 0.5 * dt)), k4 = rate(moved(k3, dt));
  return moved({(k1.x + 2.0 * (k2.x + k3.x) + k4.x) / 6.0, (k1.v + 2.0 * (k2.v + k3.v) + k4.v) / 6.0,
                (k1.p + 2.0 * (k2.p + k3.p) + k4.p) / 6.0},
               dt);
}

void HammerOnBoom::advanceTo(double time) {
  while (now_.time < time) {
    double dt = std::min(machine_.step, time - now_.time);
    const bool last = dt == time - now_.time;
    State next = stepped(now_, dt);
    if (now_.before_blow && next.x[3] > 0.0) {
      double low = 0.0, high = dt;
      for (int i = 0; i < 50 && high - low > 1e-14; ++i) {
        dt = 0.5 * (low + high);
        next = stepped(now_, dt);
        (next.x[3] > 0.0 ? high : low) = dt;
      }
      now_ = next;
      now_.x[3] = 0.0;
      blow();
      continue;
    }
    now_ = next;
    if (last) now_.time = time;
    if (now_.x[3] > kPi && !now_.before_blow) now_.x[3] -= 2.0 * kPi, now_.before_blow = true;
  }
}

/// At the dead centre crank and rocker are free of each other: five coordinates. The tool's impulse is the one after
/// which the linkage takes the rocker up without a jerk.
void HammerOnBoom::blow() {
  const double u_before = links_.rockerAngle({0.0, true, false}).first;
  const double u_after = links_.rockerAngle({0.0, false, false}).first;
  const Bodies all = bodies(now_);
  Eigen::Matrix<double, 5, 5> M = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> rotor;
  rotor << ratio_, ratio_, ratio_, 1.0, 0.0;
  M += rotor_ * rotor * rotor.transpose();
  for (std::size_t k = 0; k < 4; ++k) {
    Eigen::Matrix<double, 5, 1> x = rotor * 0.0, z = x, turn = x;
    for (int j = 0; j < 3; ++j) {
      const auto i = static_cast<std::size_t>(j);
      x[j] = all[k].by[i].real(), z[j] = all[k].by[i].imag(), turn[j] = all[k].turn[j];
    }
    if (k == 3) x[4] = all[k].by[3].real() / u_before, z[4] = all[k].by[3].imag() / u_before, turn[4] = 1.0;
    M += all[k].mass * (x * x.transpose() + z * z.transpose()) + all[k].inertia * turn * turn.transpose();
  }
  const PlanePoint to_hull = std::exp(kI * hullAngle(now_));
  const PlanePoint striker = jointPlace(now_, 3) - machine_.hammer.striking_distance / to_hull;
  Eigen::Matrix<double, 5, 1> J, v;
  for (int j = 0; j < 3; ++j) J[j] = (to_hull * -kI * (striker - jointPlace(now_, j))).imag();
  J[3] = 0.0, J[4] = machine_.hammer.striking_distance;
  v << now_.v, u_before * now_.v[3];
  const Eigen::Matrix<double, 5, 1> m = M.ldlt().solve(J);
  const double P = (u_after * v[3] - v[4]) / (m[4] - u_after * m[3]);
  const Eigen::Matrix<double, 5, 1> after = v + P * m;
  blows_.push_back({now_.time, -P * 0.5 * J.dot(v + after), P});
  now_.v = after.head<4>();
  now_.before_blow = false;
}

HammerOnBoom::State HammerOnBoom::along(const State& s, const Vector4& a, double dt) const {
  State to = s;
  to.x += dt * s.v + 0.5 * dt * dt * a;
  return to;
}

/// Of bodies from `first` on, as load about a place in axes turned by an angle; accelerations by differences in time.
Load HammerOnBoom::loadOf(const State& s, const Vector4& a, int first, PlanePoint about, double axes) const {
  constexpr double h = 2e-5;
  const Bodies now = bodies(s), later = bodies(along(s, a, h)), sooner = bodies(along(s, a, -h));
  PlanePoint force = 0.0;
  double torque = 0.0;
  for (auto k = static_cast<std::size_t>(first); k < 4; ++k) {
    const PlanePoint acceleration = (later[k].place - 2.0 * now[k].place + sooner[k].place) / (h * h);
    const PlanePoint f = -now[k].mass * (acceleration + kI * machine_.gravity);
    const double spin = now[k].turn.dot(a) + (later[k].turn - sooner[k].turn).dot(s.v) / (2.0 * h);
    force += f;
    torque += moment(now[k].place - about, f) - now[k].inertia * spin;
  }
  const double hull = a.head<3>().sum();
  torque -= rotor_ * ratio_ * (a[3] + ratio_ * hull);
  const PlanePoint turned = force * std::exp(kI * axes);
  return {turned.real(), turned.imag(), torque};
}

OnBoomTruth HammerOnBoom::truth() const {
  OnBoomTruth t;
  const Vector4 a = acceleration(now_);
  t.time = now_.time, t.speed = now_.v[3], t.acceleration = a[3];
  t.angle = now_.before_blow ? now_.x[3] + 2.0 * kPi : now_.x[3];
  const PlanePoint D = jointPlace(now_, 3);
  t.load = loadOf(now_, a, 3, D, hullAngle(now_));
  t.drive_reaction_y = -rotor_ * ratio_ * (a[3] + ratio_ * a.head<3>().sum());
  t.hold = holding(now_);
  t.displacement = now_.x.head<3>();
  HammerOnBoom cut = *this;
  cut.boom_.links[0].mass = boom_.beyond_cut.mass;
  cut.boom_.links[0].com = boom_.beyond_cut.com;
  cut.boom_.links[0].inertia = boom_.beyond_cut.inertia;
  const double axes = boom_.pose[0] + now_.x[0];
  t.cut = cut.loadOf(now_, a, 0, std::exp(-kI * axes) * boom_.cut, axes);
  constexpr double h = 2e-5;
  const PlanePoint accelerated =
      (jointPlace(along(now_, a, h), 3) - 2.0 * D + jointPlace(along(now_, a, -h), 3)) / (h * h) +
      kI * machine_.gravity;
  const PlanePoint felt = accelerated * std::exp(kI * hullAngle(now_));
  t.imu_x = felt.real(), t.imu_z = felt.imag(), t.imu_rate = now_.v.head<3>().sum();
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const OilCylinder& c = boom_.cylinders[i];
    const double lever = arm(k, boom_.pose[i]), out = lengthOf(k, boom_.pose[i]) - c.closed_length;
    const double steady = hold_[k] / lever, change = t.hold[k] / lever - steady;
    const double bore_share = c.bore_area / (c.bore_hose + c.bore_area * out);
    const double rod_share = c.rod_area / (c.rod_hose + c.rod_area * (c.stroke - out));
    const double stroke = change / (c.bore_area * bore_share + c.rod_area * rod_share);
    t.bore_pressure[i] = std::max(steady, 0.0) / c.bore_area + bore_share * stroke;
    t.rod_pressure[i] = std::max(-steady, 0.0) / c.rod_area - rod_share * stroke;
  }
  return t;
}

}  // namespace hammer_loads::simulation
