#include <cmath>

#include "hammer_loads/simulation/drive.h"
#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kInstant = 2e-5;  // step of differences in time [s]

}  // namespace

HammerOnBoom::State HammerOnBoom::along(const State& s, const Coordinates& a, double dt) const {
  State to = s;
  to.x() += dt * s.v() + 0.5 * dt * dt * a;
  return to;
}

PlanePoint HammerOnBoom::imuPlace(const State& s) const {
  const HullImuSensor& imu = machine_.on_boom.imu;
  return jointPlace(s, 3) + turnedBy(hullAngle(s)) * PlanePoint(imu.x, imu.z);
}

HammerOnBoom::Moments HammerOnBoom::momentsAbout(const Coordinates& a) const {
  Moments m{{now_, along(now_, a, kInstant), along(now_, a, -kInstant)}, {}};
  for (int i = 0; i < 3; ++i) m.rocker[i] = rockerAt(m.state[i]);
  return m;
}

/// Computes the accelerations by differences in time.
Load HammerOnBoom::loadOf(const Coordinates& a, const Moments& m, const Links& links, std::size_t first,
                          PlanePoint about, double axes) const {
  constexpr double h = kInstant;
  const Bodies now = bodies(m.state[0], links, m.rocker[0]), later = bodies(m.state[1], links, m.rocker[1]),
               sooner = bodies(m.state[2], links, m.rocker[2]);
  PlanePoint force = 0.0;
  double torque = 0.0;
  for (std::size_t k = first; k < 4; ++k) {
    const PlanePoint acceleration = (later.body[k].place - 2.0 * now.body[k].place + sooner.body[k].place) / (h * h);
    const PlanePoint f = -now.body[k].mass * (acceleration + kI * machine_.gravity);
    const double spin = now.body[k].turn.dot(a) + (later.body[k].turn - sooner.body[k].turn).dot(now_.v()) / (2.0 * h);
    force += f;
    torque += momentOf(now.body[k].place - about, f) - now.body[k].inertia * spin;
  }
  torque -= rotor_ * ratio_ * (a[3] + ratio_ * hullTurning(a));
  const PlanePoint turned = force * std::conj(turnedBy(axes));
  return {turned.real(), turned.imag(), torque};
}

/// Includes the forces of cylinders with pins on both sides of the cut, on the pins beyond it.
Load HammerOnBoom::cutLoad(const OnBoomTruth& t, const Coordinates& a, const Moments& m, const OilBoomCut& cut) const {
  const double axes = angleBefore(now_, cut.link + 1);
  const PlanePoint turn = turnedBy(axes), about = jointPlace(now_, cut.link) + turn * cut.place;
  Links links = boom_.links;
  links[cut.link] = {links[cut.link].to_next, cut.beyond.com, cut.beyond.mass, cut.beyond.inertia};
  Load load = loadOf(a, m, links, cut.link, about, axes);
  const PlanePoint foot = footPlace(now_) - about,
                   by_rock = PlanePoint(t.rock.force_x, t.rock.force_z) * turnedBy(hullAngle(now_));
  const PlanePoint rock_here = by_rock * std::conj(turn);
  load.force_x += rock_here.real(), load.force_z += rock_here.imag(), load.torque_y += momentOf(foot, by_rock);
  if (elastic_) {
    const PlanePoint by_tool = t.tool_force * kI * turnedBy(hullAngle(now_)), here = by_tool * std::conj(turn);
    load.force_x += here.real(), load.force_z += here.imag();
    load.torque_y += momentOf(strikingPlace(now_) - about, by_tool);
  }
  for (std::size_t k = cut.link; k < 3; ++k) {
    const OilCylinder& c = boom_.cylinders[k];
    const PlanePoint joint = jointPlace(now_, k), to_joint = k > cut.link ? boom_.links[k - 1].to_next : PlanePoint();
    const auto isBeyond = [&](std::size_t link, PlanePoint pin) {
      return link > cut.link || (link == cut.link && pin.real() > cut.place.real());
    };
    const bool base = k > cut.link && isBeyond(k - 1, to_joint + c.base),
               pivot = k > cut.link && isBeyond(k - 1, to_joint + c.linkage.pivot), rod = isBeyond(k, c.rod);
    const bool guided = c.linkage.guide > 0.0;
    if (base == rod && (!guided || pivot == rod)) continue;
    const double angle = now_.x()[static_cast<int>(k)], push = t.hold[static_cast<int>(k)] / c.arm(angle);
    const PlanePoint before = turnedBy(k == 0 ? 0.0 : bentAngle(now_, k - 1));
    const OilCylinder::Pins pins = c.pins(angle);
    const auto add = [&](PlanePoint pin, PlanePoint share) {
      const PlanePoint force = push * before * share, turned = force * std::conj(turn);
      load.force_x += turned.real(), load.force_z += turned.imag();
      load.torque_y += momentOf(joint + before * pin - about, force);
    };
    if (base) add(c.base, pins.on_base);
    if (guided && pivot) add(c.linkage.pivot, pins.on_pivot);
    if (rod) add(turnedBy(angle) * c.rod, pins.on_driven);
  }
  return load;
}

OnBoomSensors HammerOnBoom::sensors(const Hold& hold, const Coordinates& a) const {
  OnBoomSensors s;
  s.angles = now_.x().head<3>(), s.rates = now_.v().head<3>();
  const PlanePoint later = imuPlace(along(now_, a, kInstant)), sooner = imuPlace(along(now_, a, -kInstant));
  const PlanePoint acceleration = (later - 2.0 * imuPlace(now_) + sooner) / (kInstant * kInstant);
  const double axes = hullAngle(now_) + machine_.on_boom.imu.pitch;
  const PlanePoint felt = (acceleration + kI * machine_.gravity) * std::conj(turnedBy(axes));
  s.imu_x = felt.real(), s.imu_z = felt.imag(), s.imu_rate = hullTurning(now_.v());
  readCylinders(hold, s);
  return s;
}

OnBoomSensors HammerOnBoom::sensors() const {
  const Hold hold = holdAt(now_.time);
  return sensors(hold, acceleration(now_, hold));
}

OnBoomTruth HammerOnBoom::truth() const {
  OnBoomTruth t;
  const Hold hold = holdAt(now_.time);
  const Coordinates a = acceleration(now_, hold);
  t.time = now_.time;
  t.turn = turn_;
  t.angle = now_.before_blow ? now_.x()[3] + 2.0 * kPi : now_.x()[3];
  if (t.angle >= kTwoPi) t.angle = std::nextafter(kTwoPi, 0.0);
  t.speed = t.motor_speed = now_.v()[3];
  t.acceleration = a[3];
  t.pressure = now_.y[kPressure];
  t.hull_pitch = hullAngle(now_);
  const Moments moments = momentsAbout(a);
  t.load = loadOf(a, moments, boom_.links, 3, jointPlace(now_, 3), t.hull_pitch);
  t.drive_reaction_y = -rotor_ * ratio_ * (a[3] + ratio_ * hullTurning(a));
  t.load.torque_y -= t.drive_reaction_y;
  if (elastic_) {
    const StruckTool::Answer answer = struck(now_);
    const RodStretch rod = elastic_->links.rod({now_.x()[3], now_.x()[4]});
    t.tool_force = answer.tool, t.retainer_force = answer.retainer;
    t.rod_force = -elastic_->rod.tension(rod.stretch, rod.rate({now_.v()[3], now_.v()[4]}));
    t.rocker_angle = now_.x()[4], t.rocker_speed = now_.v()[4];
    t.load.force_z += t.tool_force;
    t.load.torque_y +=
        momentOf((strikingPlace(now_) - jointPlace(now_, 3)) * std::conj(turnedBy(t.hull_pitch)), t.tool_force * kI);
  }
  static_cast<OnBoomSensors&>(t) = sensors(hold, a);
  t.displacement = t.angles - hold.state.x().head<3>();
  t.hold = holding(now_, hold);
  t.rock = rockLoad(hold.state);
  for (std::size_t i = 0; i < t.cut.size(); ++i) t.cut[i] = cutLoad(t, a, moments, boom_.cuts[i]);
  return t;
}

}  // namespace hammer_loads::simulation
