#include "hammer_loads/linkage/two_bodies.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr double kBallistic = 1e-4;  // [rad]: below it the spring has no effect within a step

constexpr double kSlides = 0.5;  // [rad/s]: a faster pin slides
// Numerical: kSlides

constexpr double kContact = 1.2e-4;  // [s]; part of a step within which pins with joint clearance may separate or meet
// Numerical: kContact

/// Advances y'' = pull - square y - 2 decay y' by a time.
void oscillate(double square, double decay, double pull, double time, double& y, double& speed) noexcept {
  if (!(square * time * time > kBallistic * kBallistic)) {
    y += time * (speed + 0.5 * time * pull);
    speed += time * pull;
    return;
  }
  const double rest_at = pull / square;
  y -= rest_at;
  Oscillator{square, decay}.move(time, y, speed);
  y += rest_at;
}

/// Tension of a rod [N]. With joint clearance, either side of a pin can only push.
double tension(const RodSpring& rod, double stretch, double rate) noexcept {
  const double half = 0.5 * rod.play, pressed = stretch - std::clamp(stretch, -half, half);
  const double both = rod.stiffness * pressed + rod.damping() * rate;
  if (!(half > 0.0)) return both;
  return pressed > 0.0 ? std::max(0.0, both) : (pressed < 0.0 ? std::min(0.0, both) : 0.0);
}

/// psi of a rigid rod [rad], of either sign beyond the dead centre.
double rigidRockerAngle(const LinkMotion& links) noexcept {
  return std::atan2(links.rocker.sin_psi, links.rocker.cos_psi);
}

}  // namespace

/// Terms of the equations of motion at a state, without x, its rate and the crank's acceleration.
struct TwoBodies::Local {
  double reflected{}, coupling{};     ///< J, B [kg m2]
  double per_reflected{}, per_own{};  ///< 1/J, 1/(M22 - B^2/J) [1/(kg m2)]
  double on_crank{}, on_rocker{};     ///< F1 without the spring, F2 [N m]
  double lever{}, secant_lever{};     ///< h = -d(stretch)/dx, -stretch/x [m]
  double by_crank{};                  ///< d(stretch)/dphi at x [m]
};

TwoBodies::TwoBodies(const Mechanism& mechanism) noexcept : mechanism_(&mechanism) {
  const LinkMoments& k = mechanism.moments();
  const LinkLengths& l = mechanism.linkage().lengths();
  const double crank = l.crank / l.rod, rocker = l.rocker / l.rod;
  crank_ = k.crank_inertia + crank * (k.rod_inertia * crank - 2.0 * k.coupling.re);
  rocker_ = mechanism.parameters().rocker_inertia_about_pivot + k.rod_inertia * rocker * rocker;
  coupling_ = rocker * (k.coupling - Planar{k.rod_inertia * crank, 0.0});
  crank_weight_ = k.crank - crank * k.rod;
  rocker_weight_ = Planar{k.rocker, 0.0} + rocker * k.rod;
}

TwoBodies::Local TwoBodies::local(const TwoBodyDrive& drive, const TwoBodyState& at,
                                  const LinkMotion& links) const noexcept {
  const LinkLengths& l = mechanism_->linkage().lengths();
  const double u = links.rocker.u, w = at.speed, x = at.displacement, v = u * w + at.displacement_rate, ww = w * w;
  const Planar theta = links.psi * conj(links.phi), both = coupling_ * theta;
  const double slope = -both.im;  // derivative of M12 by theta
  const auto weight = [&](Planar moment, Planar direction) {
    const Planar rate = moment * direction;
    return drive.gravity.z * rate.re + drive.gravity.x * rate.im;
  };
  const double on_rocker = weight(rocker_weight_, links.psi);
  Local a;
  a.coupling = both.re + u * rocker_;
  a.reflected = drive.inertia + crank_ + u * (both.re + a.coupling);
  a.per_reflected = 1.0 / a.reflected;
  a.per_own = 1.0 / (rocker_ - a.coupling * a.coupling * a.per_reflected);
  a.on_rocker = on_rocker - rocker_ * links.rocker.du * ww + slope * ww;
  a.on_crank = drive.torque + weight(crank_weight_, links.phi) + u * on_rocker - a.coupling * links.rocker.du * ww -
               slope * v * v + u * slope * ww;
  const double curve = l.rocker * (l.rocker / l.rod - links.cos_mu);
  a.lever = l.rocker * links.sin_mu - curve * x;
  a.secant_lever = l.rocker * links.sin_mu - 0.5 * curve * x;
  a.by_crank = -l.rocker * links.cos_mu * links.rocker.cos_half * links.rocker.inv_r * x;
  return a;
}

/// Adds the generalised forces of friction, by virtual work; moment: of each pin [N m]. The rod turns at a w + b v.
void TwoBodies::addFriction(double moment, const TwoBodyState& s, const LinkMotion& links, Local& a) const noexcept {
  const LinkLengths& l = mechanism_->linkage().lengths();
  const double by_crank = -l.crank / l.rod * (conj(links.beta) * links.phi).re;  // a
  const double by_rocker = l.rocker / l.rod * links.cos_mu;                      // b
  const double w = s.speed, v = links.rocker.u * w + s.displacement_rate, rod = by_crank * w + by_rocker * v;
  const auto sign = [](double speed) { return speed / std::sqrt(speed * speed + kSlides * kSlides); };
  const double at_crank = sign(rod - w), at_rocker = sign(rod - v);
  const double on_rocker = -moment * (sign(v) + at_crank * by_rocker + at_rocker * (by_rocker - 1.0));
  a.on_rocker += on_rocker;
  a.on_crank -= moment * (sign(w) + at_crank * (by_crank - 1.0) + at_rocker * by_crank) - links.rocker.u * on_rocker;
}

void TwoBodies::move(const RodSpring& rod, const TwoBodyDrive& drive, double dt, TwoBodyState& s,
                     LinksMemo& memo) const noexcept {
  const TwoBodyState from = s;
  TwoBodyState middle = s;
  middle.angle.offset += 0.5 * dt * s.speed;
  middle.displacement += 0.5 * dt * s.displacement_rate;
  if (!(middle.angle == memo.angle)) memo = {middle.angle, links(middle.angle)};
  const LinkMotion& there = memo.links;
  Local a = local(drive, middle, there);
  const double damping = rod.damping(), half = 0.5 * rod.play;
  const auto tensionAt = [&](const TwoBodyState& at) {
    return tension(rod, -a.secant_lever * at.displacement, a.by_crank * at.speed - a.lever * at.displacement_rate);
  };
  const auto isFree = [&](const TwoBodyState& at) {
    return half > 0.0 && (std::abs(a.secant_lever * at.displacement) < half || tensionAt(at) == 0.0);
  };
  const bool free = isFree(middle);
  if (rod.friction_radius > 0.0 && !free)
    addFriction(rod.friction_radius * std::abs(tensionAt(middle)), middle, there, a);
  // tension = -stiff x - damped x' - apart, at the middle's levers
  const double stiff = free ? 0.0 : rod.stiffness * a.secant_lever;
  const double damped = free ? 0.0 : damping * a.lever;
  const double to_side = half > 0.0 ? rod.stiffness * std::copysign(half, -a.secant_lever * middle.displacement) : 0.0;
  const double apart = free ? 0.0 : to_side - damping * a.by_crank * s.speed;
  const double back = a.coupling * a.per_reflected;
  const double per =
      (a.lever + back * a.by_crank) * a.per_own;  // acceleration per tension, which also pulls at the crank
  const double pull = (a.on_rocker - back * a.on_crank) * a.per_own - per * apart;
  oscillate(std::max(0.0, per * stiff), 0.5 * per * damped, pull, dt, s.displacement, s.displacement_rate);
  const double moved = s.displacement - from.displacement, gained = s.displacement_rate - from.displacement_rate;
  const double force = -stiff * 0.5 * (from.displacement + s.displacement) - damped * moved / dt - apart;
  const double rate_of_crank = (a.on_crank - force * a.by_crank) * a.per_reflected;
  s.angle.offset += dt * (s.speed + 0.5 * dt * rate_of_crank) - back * (moved - dt * from.displacement_rate);
  s.speed += dt * rate_of_crank - back * gained;
  // The step is halved if pins separate or meet within it.
  if (half > 0.0 && dt > kContact && (isFree(from) != free || isFree(s) != free)) {
    s = from;
    move(rod, drive, 0.5 * dt, s, memo);
    move(rod, drive, 0.5 * dt, s, memo);
  }
}

void TwoBodies::settle(const RodSpring& rod, const TwoBodyDrive& drive, TwoBodyState& s) const noexcept {
  s.displacement = s.displacement_rate = 0.0;
  const Local a = local(drive, s, links(s.angle));
  const double pull = a.on_rocker - a.coupling * a.per_reflected * a.on_crank;
  s.displacement = pull / (rod.stiffness * a.lever * a.lever) + std::copysign(0.5 * rod.play, pull) / std::abs(a.lever);
}

/// Moves the state onto the branch after the blow: the rocker's speed is reversed, the crank's momentum kept.
void TwoBodies::strike(const TwoBodyDrive& drive, double restitution, TwoBodyState& s) const noexcept {
  const LinkMotion before = links(s.angle);
  const double v = before.rocker.u * s.speed + s.displacement_rate, gained = -(1.0 + restitution) * v;
  s.speed -= (coupling_ * (before.psi * conj(before.phi))).re / (drive.inertia + crank_) * gained;
  s.angle.side = Side::kAfterBlow;
  const LinkMotion after = links(s.angle);
  s.displacement += rigidRockerAngle(before) - rigidRockerAngle(after);
  s.displacement_rate = v + gained - after.rocker.u * s.speed;
}

std::optional<TwoBodies::Blow> TwoBodies::moveToTool(const RodSpring& rod, const TwoBodyDrive& drive, const Tool& tool,
                                                     double dt, TwoBodyState& s, LinksMemo& memo) const noexcept {
  const TwoBodyState from = s;
  move(rod, drive, dt, s, memo);
  if (s.angle.side == Side::kAfterBlow) return std::nullopt;
  const double there = links(s.angle).rocker.sin_psi + s.displacement - tool.place;
  if (there > 0.0) return std::nullopt;
  const double here = links(from.angle).rocker.sin_psi + from.displacement - tool.place;
  const double part = here > 0.0 ? here / (here - there) : 0.0;
  s = from;
  if (part > 0.0) move(rod, drive, part * dt, s);
  Blow blow{part * dt, s, s};
  strike(drive, tool.restitution, blow.after);
  s = blow.after;
  if (part < 1.0) move(rod, drive, (1.0 - part) * dt, s);
  return blow;
}

void TwoBodies::strikeEarly(const TwoBodyDrive& drive, const Tool& tool, TwoBodyState& s) const noexcept {
  const LinkMotion at = links(s.angle);
  const double away = at.rocker.sin_psi + s.displacement - tool.place,
               speed = at.rocker.u * s.speed + s.displacement_rate;
  const double time = speed < 0.0 ? -away / speed : 0.0;
  s.angle.offset += time * s.speed;
  s.displacement += time * s.displacement_rate;
  strike(drive, tool.restitution, s);
  s.angle.offset -= time * s.speed;
  s.displacement -= time * s.displacement_rate;
}

TwoBodyAccelerations TwoBodies::accelerations(const RodSpring& rod, const TwoBodyDrive& drive, const TwoBodyState& s,
                                              const LinkMotion& links) const noexcept {
  Local a = local(drive, s, links);
  const double force =
      tension(rod, -a.secant_lever * s.displacement, a.by_crank * s.speed - a.lever * s.displacement_rate);
  if (rod.friction_radius > 0.0) addFriction(rod.friction_radius * std::abs(force), s, links, a);
  const double on_crank = a.on_crank - force * a.by_crank;
  const double displacement = (a.on_rocker + force * a.lever - a.coupling * a.per_reflected * on_crank) * a.per_own;
  const double crank = (on_crank - a.coupling * displacement) * a.per_reflected;
  return {crank, links.rocker.u * crank + links.rocker.du * s.speed * s.speed + displacement, force};
}

double TwoBodies::rigidAcceleration(const TwoBodyDrive& drive, const TwoBodyState& s,
                                    const LinkMotion& links) const noexcept {
  const Local a = local(drive, {s.angle, s.speed, 0.0, 0.0}, links);
  return a.on_crank * a.per_reflected;
}

LinkAccelerations TwoBodies::linkAccelerations(const TwoBodyState& s, const TwoBodyAccelerations& a,
                                               const LinkMotion& links) const noexcept {
  const double v = links.rocker.u * s.speed + s.displacement_rate;
  return withRod({-s.speed * s.speed, a.crank}, {-v * v, a.rocker}, links);
}

LinkAccelerations TwoBodies::linkSpeeds(const TwoBodyState& s, const LinkMotion& links) const noexcept {
  return withRod({0.0, s.speed}, {0.0, links.rocker.u * s.speed + s.displacement_rate}, links);
}

/// Completes the links by the rod, whose value follows from those of its pins.
LinkAccelerations TwoBodies::withRod(Planar crank, Planar rocker, const LinkMotion& links) const noexcept {
  const LinkLengths& l = mechanism_->linkage().lengths();
  LinkAccelerations q;
  q.crank = crank, q.rocker = rocker;
  q.rod = conj(links.beta) * ((l.rocker / l.rod) * (links.psi * rocker) - (l.crank / l.rod) * (links.phi * crank));
  return q;
}

}  // namespace hammer_loads
