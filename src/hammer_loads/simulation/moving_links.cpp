#include "hammer_loads/simulation/moving_links.h"

#include <stdexcept>
#include <string>

namespace hammer_loads::simulation {
namespace {

/// Cosine and sine of the crank angle phi as jets in phi.
struct CrankPlace {
  Jet cos, sin;
  Jet sin_half;  ///< sine of phi/2 within the revolution, phi in [0, 2 pi]: from the offset, so that it is exact at
                 ///< both ends
};

CrankPlace placeOf(TurnAngle angle) noexcept {
  const double s = std::sin(0.5 * angle.offset), c = std::cos(0.5 * angle.offset);
  const double sin_phi = 2.0 * s * c, cos_phi = (c - s) * (c + s);
  const Jet half{s, 0.5 * c, -0.25 * s};
  return {{cos_phi, -sin_phi, -cos_phi}, {sin_phi, cos_phi, -sin_phi}, angle.before_blow ? -1.0 * half : half};
}

}  // namespace

Mechanism mechanismFrom(const HammerParameters& parameters) {
  const Checked<Mechanism> made = Mechanism::make(parameters);
  if (made.value) return *made.value;
  std::string all;
  for (const std::string& problem : made.problems) all += (all.empty() ? "" : "; ") + problem;
  throw std::invalid_argument(all);
}

MovingLinks::MovingLinks(const Mechanism& mechanism, Level level)
    : p_(mechanism.parameters()),
      level_(level),
      cos_a_(std::cos(p_.rocker_com_angle)),
      sin_a_(std::sin(p_.rocker_com_angle)) {}

/// psi = 2 delta - alpha. alpha is the angle from DA to DB, and pi - 2 delta the angle B-D-C of a triangle with sides
/// c = DB, l3, l2. sin^2 delta = ((l3 + c)^2 - l2^2)/(4 l3 c), where c - (l2 - l3) = 4 l0 l1 s^2/(c + l0 - l1).
Jet MovingLinks::rockerAngleUp(TurnAngle angle) const noexcept {
  const double l0 = p_.lengths.pivot_distance, l1 = p_.lengths.crank, l2 = p_.lengths.rod, l3 = p_.lengths.rocker;
  const auto [cos_phi, sin_phi, s] = placeOf(angle);
  const Jet c = sqrt(4.0 * l0 * l1 * (s * s) + (l0 - l1) * (l0 - l1));
  const Jet delta = asin(s * sqrt((l0 * l1 / l3) * (c + (l2 + l3)) / (c * (c + (l0 - l1)))));
  const Jet alpha = atan(l1 * sin_phi / (l0 - l1 * cos_phi));  // |alpha| < pi/2 since l1 < l0
  return 2.0 * delta - alpha;
}

/// The mirrored branch is the image of this one in the line A-D: psi(phi) = -psi(-phi).
Jet MovingLinks::rockerAngle(TurnAngle angle) const noexcept {
  if (!angle.mirrored) return rockerAngleUp(angle);
  const Jet image = rockerAngleUp({-angle.offset, !angle.before_blow, false});
  return {-image.value, image.first, -image.second};
}

LinkBodies MovingLinks::at(TurnAngle angle) const noexcept {
  const double l0 = p_.lengths.pivot_distance, l1 = p_.lengths.crank, l2 = p_.lengths.rod, l3 = p_.lengths.rocker;
  LinkBodies all;
  const Jet psi = rockerAngle(angle);
  const Jet cos_psi = cos(psi), sin_psi = sin(psi);
  const double m3 = p_.rocker_mass, ls = p_.rocker_com_distance, along = ls * cos_a_, across = ls * sin_a_;
  all.body[all.count++] = {m3, p_.rocker_inertia_about_pivot - m3 * ls * ls, along * cos_psi - across * sin_psi + l0,
                           along * sin_psi + across * cos_psi, psi};
  if (level_ == Level::kRocker) return all;

  const CrankPlace place = placeOf(angle);
  const Jet &cos_phi = place.cos, &sin_phi = place.sin;
  all.body[all.count++] = {p_.crank_mass,
                           p_.crank_inertia_about_com,
                           p_.crank_com_along * cos_phi - p_.crank_com_across * sin_phi,
                           p_.crank_com_along * sin_phi + p_.crank_com_across * cos_phi,
                           {angle.offset, 1.0, 0.0}};
  const Jet b_xi = l1 * cos_phi, b_eta = l1 * sin_phi;
  const Jet cos_beta = (1.0 / l2) * (l3 * cos_psi + l0 - b_xi), sin_beta = (1.0 / l2) * (l3 * sin_psi - b_eta);
  const Jet beta{0.0, cos_beta.value * sin_beta.first - sin_beta.value * cos_beta.first,
                 cos_beta.value * sin_beta.second - sin_beta.value * cos_beta.second};
  all.body[all.count++] = {p_.rod_mass, p_.rod_inertia_about_com,
                           b_xi + (p_.rod_com_along * cos_beta - p_.rod_com_across * sin_beta),
                           b_eta + (p_.rod_com_along * sin_beta + p_.rod_com_across * cos_beta), beta};
  return all;
}

ShaftView MovingLinks::shaft(const LinkBodies& links, Gravity gravity) const noexcept {
  // The map between hull and mechanism frame is a reflection, hence its own inverse.
  const double g_xi = -(cos_a_ * gravity.x + sin_a_ * gravity.z), g_eta = -sin_a_ * gravity.x + cos_a_ * gravity.z;
  ShaftView view;
  for (int i = 0; i < links.count; ++i) {
    const LinkBodies::Body& b = links.body[i];
    view.inertia += b.mass * (b.xi.first * b.xi.first + b.eta.first * b.eta.first) +
                    b.inertia_about_com * b.angle.first * b.angle.first;
    view.inertia_slope += 2.0 * (b.mass * (b.xi.first * b.xi.second + b.eta.first * b.eta.second) +
                                 b.inertia_about_com * b.angle.first * b.angle.second);
    view.weight_torque += b.mass * (g_xi * b.xi.first + g_eta * b.eta.first);
  }
  return view;
}

Load MovingLinks::load(const LinkBodies& links, double speed, double acceleration, Gravity gravity) const noexcept {
  const double g_xi = -(cos_a_ * gravity.x + sin_a_ * gravity.z), g_eta = -sin_a_ * gravity.x + cos_a_ * gravity.z;
  const double ww = speed * speed;
  double f_xi = 0.0, f_eta = 0.0, torque = 0.0;
  for (int i = 0; i < links.count; ++i) {
    const LinkBodies::Body& b = links.body[i];
    const double b_xi = b.mass * (g_xi - b.xi.second * ww - b.xi.first * acceleration);
    const double b_eta = b.mass * (g_eta - b.eta.second * ww - b.eta.first * acceleration);
    f_xi += b_xi;
    f_eta += b_eta;
    torque += (b.xi.value - p_.lengths.pivot_distance) * b_eta - b.eta.value * b_xi -
              b.inertia_about_com * (b.angle.second * ww + b.angle.first * acceleration);
  }
  return {-(cos_a_ * f_xi + sin_a_ * f_eta), -sin_a_ * f_xi + cos_a_ * f_eta, torque};
}

/// Crank, rod and rocker are in line at the blow, so that the rod transmits only the moment of its inertia about B.
Strike MovingLinks::strike(double crank_speed) const noexcept {
  const TurnAngle before{0.0, true}, after{0.0, false};
  const double u_before = rockerAngle(before).first, u_after = rockerAngle(after).first;
  Strike strike;
  strike.rocker_speed_before = u_before * crank_speed;
  strike.rocker_speed_after = u_after * crank_speed;
  strike.energy = 0.5 * (shaft(at(before), {}).inertia - shaft(at(after), {}).inertia) * crank_speed * crank_speed;
  double inertia = p_.rocker_inertia_about_pivot;
  if (level_ == Level::kLinkage) {
    const double rod_about_b = p_.rod_inertia_about_com + p_.rod_mass * (p_.rod_com_along * p_.rod_com_along +
                                                                         p_.rod_com_across * p_.rod_com_across);
    const double ratio = p_.lengths.rocker / p_.lengths.rod;
    inertia += rod_about_b * ratio * ratio;
  }
  strike.tool_impulse = inertia * (u_after - u_before) * crank_speed / p_.striking_distance;
  strike.crank_speed_after = crank_speed;
  return strike;
}

/// Crank speed w and rocker speed p are independent at the dead centre, with the kinetic energy
/// (M11 w^2 + 2 M12 w p + M22 p^2)/2. The tool's impulse acts on p alone. Then the loop, p = u w, closes by an internal
/// impulse, which conserves the momentum along (1, u).
Strike MovingLinks::strike(double crank_speed, double restitution, double drive_inertia) const noexcept {
  const TurnAngle before{0.0, true}, after{0.0, false};
  const double u_before = rockerAngle(before).first, u = rockerAngle(after).first;
  double m12 = 0.0, m22 = p_.rocker_inertia_about_pivot;
  if (level_ == Level::kLinkage) {
    const double to_com = p_.rod_com_along / p_.lengths.rod, across = p_.rod_com_across / p_.lengths.rod;
    const double about_com =
        p_.rod_inertia_about_com / (p_.lengths.rod * p_.lengths.rod) + p_.rod_mass * across * across;
    // Pins B and C move at l1 w and l3 p; the rod's centre of mass is in between.
    m12 = p_.lengths.crank * p_.lengths.rocker * (p_.rod_mass * to_com * (1.0 - to_com) - about_com);
    m22 += p_.lengths.rocker * p_.lengths.rocker * (p_.rod_mass * to_com * to_com + about_com);
  }
  const double total = drive_inertia + shaft(at(after), {}).inertia;
  const double m11 = total - 2.0 * u * m12 - u * u * m22;
  const auto energy = [&](double w, double p) { return 0.5 * (m11 * w * w + 2.0 * m12 * w * p + m22 * p * p); };
  Strike strike;
  const double p0 = strike.rocker_speed_before = u_before * crank_speed;
  const double p1 = strike.rocker_speed_after = -restitution * p0;
  const double w1 = crank_speed + m12 / m11 * (p0 - p1);
  strike.crank_speed_after = (m11 * w1 + m12 * p1 + u * (m12 * w1 + m22 * p1)) / total;
  strike.energy = energy(crank_speed, p0) - energy(w1, p1);
  strike.linkage_loss = energy(w1, p1) - 0.5 * total * strike.crank_speed_after * strike.crank_speed_after;
  strike.tool_impulse = (m12 * (w1 - crank_speed) + m22 * (p1 - p0)) / p_.striking_distance;
  return strike;
}

Strike MovingLinks::strikeTool(TurnAngle angle, double crank_speed, double tool_mass,
                               double drive_inertia) const noexcept {
  const LinkBodies links = at(angle);
  const double u = rockerAngle(angle).first, arm = u * p_.striking_distance;
  const double before = drive_inertia + shaft(links, {}).inertia, after = before + tool_mass * arm * arm;
  Strike strike;
  strike.crank_speed_after = crank_speed * before / after;
  strike.rocker_speed_before = u * crank_speed;
  strike.rocker_speed_after = u * strike.crank_speed_after;
  strike.energy = 0.5 * before * (crank_speed * crank_speed - strike.crank_speed_after * strike.crank_speed_after);
  strike.tool_impulse = -tool_mass * arm * strike.crank_speed_after;
  return strike;
}

}  // namespace hammer_loads::simulation
