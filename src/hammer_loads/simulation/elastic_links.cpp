#include "hammer_loads/simulation/elastic_links.h"

#include <algorithm>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

using Place = std::complex<double>;
constexpr Place kTurned{0.0, 1.0};
constexpr double kRatioAt = 200.0;  // frequency of the damping ratio [Hz] (RodSettings)
constexpr double kFilm = 5e-6;      // compression at which the damper of a pin with joint clearance acts fully [m]

double dot(Place a, Place b) { return a.real() * b.real() + a.imag() * b.imag(); }
double cross(Place a, Place b) { return a.real() * b.imag() - a.imag() * b.real(); }
Place onCircle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

}  // namespace

RodSpring::RodSpring(const RodSettings& rod) noexcept
    : stiffness_(rod.stiffness),
      damping_(rod.damping_ratio * rod.stiffness / (kPi * kRatioAt)),
      half_play_(0.5 * rod.play) {}

double RodSpring::pressed(double stretch) const noexcept {
  return stretch - std::clamp(stretch, -half_play_, half_play_);
}

double RodSpring::tension(double stretch, double rate) const noexcept {
  if (half_play_ == 0.0) return stiffness_ * stretch + damping_ * rate;
  const double way = pressed(stretch);
  const double both = stiffness_ * way + damping_ * rate * std::min(1.0, std::abs(way) / kFilm);
  return way > 0.0 ? std::max(0.0, both) : std::min(0.0, both);
}

double RodSpring::energy(double stretch) const noexcept { return 0.5 * stiffness_ * std::pow(pressed(stretch), 2); }

ElasticLinks::ElasticLinks(const HammerParameters& parameters, Level level)
    : p_(mechanismFrom(parameters).parameters()),
      level_(level),
      cos_a_(std::cos(p_.rocker_com_angle)),
      sin_a_(std::sin(p_.rocker_com_angle)) {}

RodStretch ElasticLinks::rod(const TwoBodies& angle) const noexcept {
  return rodBetween(onCircle(p_.lengths.crank, angle[0]), onCircle(p_.lengths.rocker, angle[1]));
}

RodStretch ElasticLinks::rodBetween(Place b, Place c) const noexcept {
  const Place along = c + p_.lengths.pivot_distance - b;
  const double length = std::abs(along);
  return {length - p_.lengths.rod, {-dot(along, kTurned * b) / length, dot(along, kTurned * c) / length}};
}

ElasticLinks::View ElasticLinks::at(const TwoBodies& angle, const TwoBodies& speed) const noexcept {
  View view;
  const Place out = onCircle(1.0, angle[0]), b = p_.lengths.crank * out;
  view.rocker = rockerAt(angle[1]);
  const Place c = p_.lengths.rocker * view.rocker;
  view.rod = rodBetween(b, c);
  const double ww = speed[0] * speed[0], vv = speed[1] * speed[1], ls = p_.rocker_com_distance;
  const Place s = onCircle(ls, angle[1] + p_.rocker_com_angle);
  Body& rocker = view.body[view.count++];
  rocker = {p_.rocker_mass,
            p_.rocker_inertia_about_pivot - p_.rocker_mass * ls * ls,
            s + p_.lengths.pivot_distance,
            {},
            {},
            -vv * s,
            0.0};
  rocker.slope[1] = kTurned * s, rocker.turn[1] = 1.0;
  if (level_ == Level::kRocker) return view;

  const Place com = Place(p_.crank_com_along, p_.crank_com_across) * out;
  Body& crank = view.body[view.count++];
  crank = {p_.crank_mass, p_.crank_inertia_about_com, com, {}, {}, -ww * com, 0.0};
  crank.slope[0] = kTurned * com, crank.turn[0] = 1.0;

  const Place share = Place(p_.rod_com_along, p_.rod_com_across) / p_.lengths.rod;  // relative to BC
  const Place along = c + p_.lengths.pivot_distance - b, by_crank = -kTurned * b, by_rocker = kTurned * c;
  const Place moving = speed[0] * by_crank + speed[1] * by_rocker, bending = ww * b - vv * c;
  const double square = std::norm(along);
  Body& rod = view.body[view.count++];
  rod.mass = p_.rod_mass, rod.inertia = p_.rod_inertia_about_com;
  rod.place = b + share * along;
  rod.slope[0] = kTurned * b + share * by_crank, rod.slope[1] = share * by_rocker;
  rod.turn[0] = cross(along, by_crank) / square, rod.turn[1] = cross(along, by_rocker) / square;
  rod.by_speeds = -ww * b + share * bending;
  rod.turn_by_speeds = (cross(along, bending) - 2.0 * cross(along, moving) * dot(along, moving) / square) / square;
  return view;
}

std::array<double, 3> ElasticLinks::inertia(const View& view) const noexcept {
  std::array<double, 3> M{};
  for (int i = 0; i < view.count; ++i) {
    const Body& b = view.body[i];
    M[0] += b.mass * std::norm(b.slope[0]) + b.inertia * b.turn[0] * b.turn[0];
    M[1] += b.mass * dot(b.slope[0], b.slope[1]) + b.inertia * b.turn[0] * b.turn[1];
    M[2] += b.mass * std::norm(b.slope[1]) + b.inertia * b.turn[1] * b.turn[1];
  }
  return M;
}

/// The map between hull and mechanism frame is a reflection, hence its own inverse.
Place ElasticLinks::inMechanism(Gravity gravity) const noexcept {
  return {-(cos_a_ * gravity.x + sin_a_ * gravity.z), -sin_a_ * gravity.x + cos_a_ * gravity.z};
}

TwoBodies ElasticLinks::weight(const View& view, Gravity gravity) const noexcept {
  const Place g = inMechanism(gravity);
  TwoBodies torque{};
  for (int i = 0; i < view.count; ++i)
    for (int k = 0; k < 2; ++k) torque[k] += view.body[i].mass * dot(g, view.body[i].slope[k]);
  return torque;
}

TwoBodies ElasticLinks::inertiaOfSpeeds(const View& view) const noexcept {
  TwoBodies torque{};
  for (int i = 0; i < view.count; ++i) {
    const Body& b = view.body[i];
    for (int k = 0; k < 2; ++k)
      torque[k] -= b.mass * dot(b.by_speeds, b.slope[k]) + b.inertia * b.turn_by_speeds * b.turn[k];
  }
  return torque;
}

Load ElasticLinks::load(const View& view, const TwoBodies& acceleration, Gravity gravity,
                        double tool_force) const noexcept {
  const Place g = inMechanism(gravity);
  Place force;
  double torque = tool_force * p_.striking_distance * view.rocker.real();
  for (int i = 0; i < view.count; ++i) {
    const Body& b = view.body[i];
    const Place a = b.by_speeds + acceleration[0] * b.slope[0] + acceleration[1] * b.slope[1];
    const Place f = b.mass * (g - a);
    force += f;
    torque += cross(b.place - p_.lengths.pivot_distance, f) -
              b.inertia * (b.turn_by_speeds + acceleration[0] * b.turn[0] + acceleration[1] * b.turn[1]);
  }
  return {-(cos_a_ * force.real() + sin_a_ * force.imag()), -sin_a_ * force.real() + cos_a_ * force.imag() + tool_force,
          torque};
}

double ElasticLinks::rockerAngle(double crank_angle) const noexcept {
  const Place to_b = onCircle(p_.lengths.crank, crank_angle) - p_.lengths.pivot_distance;
  const double l2 = p_.lengths.rod, l3 = p_.lengths.rocker, d = std::abs(to_b);
  const double at_d = std::acos(std::clamp((l3 * l3 + d * d - l2 * l2) / (2.0 * l3 * d), -1.0, 1.0));
  const double to = std::arg(to_b);
  return (to < 0.0 ? to + kTwoPi : to) - at_d;
}

}  // namespace hammer_loads::simulation
