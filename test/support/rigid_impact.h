/// A blow by free rigid bodies, pins as constraints and Coulomb's friction: shares no formula with hammer/blow.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::test {

/// Impulses of a blow, axes of hammer_hull.
struct RigidImpact {
  Eigen::Vector2d tool = Eigen::Vector2d::Zero();  ///< BY the tool ON the rocker (x, z) [N s]
  Eigen::Vector2d hull = Eigen::Vector2d::Zero();  ///< BY the rocker ON the hull at D [N s]
  double energy{};                                 ///< given to the tool along z [J]
  double friction_work{};                          ///< [J]
  bool sticks{};                                   ///< K stays on the tool: there is no rebound
};

/// Rocker (a free body in the plane) and the rod's reduced mass (a particle), held together by the pins at D and C.
/// Coordinates: velocity of the rocker's centre of mass (x, z), its turning rate about +y, velocity of the particle.
class ImpactingRocker {
 public:
  explicit ImpactingRocker(const StrikingRocker& rocker) : r_(rocker) {
    const double com_squared = r_.com.x * r_.com.x + r_.com.z * r_.com.z;
    mass_ << r_.mass, r_.mass, r_.inertia_about_pivot - r_.mass * com_squared, particle(), particle();
    pins_.setZero();
    // A turning rate q about +y moves a point at (x, z) from the centre of mass by q (z, -x).
    pins_.block<1, 3>(0, 0) << 1.0, 0.0, -r_.com.z;  // of D
    pins_.block<1, 3>(1, 0) << 0.0, 1.0, r_.com.x;
    const double x = r_.rod_joint.x - r_.com.x, z = r_.rod_joint.z - r_.com.z;
    pins_.row(2) << 1.0, 0.0, z, -1.0, 0.0;  // of C
    pins_.row(3) << 0.0, 1.0, -x, 0.0, -1.0;
    const double kx = r_.striking_point.x - r_.com.x, kz = r_.striking_point.z - r_.com.z;
    contact_.row(0) << 1.0, 0.0, kz, 0.0, 0.0;
    contact_.row(1) << 0.0, 1.0, -kx, 0.0, 0.0;
  }

  /// From a turning rate before to one after [rad/s].
  RigidImpact strike(double before, double after) const {
    RigidImpact impact;
    Eigen::Matrix<double, 5, 1> v;
    // Every point turns about D.
    v << before * r_.com.z, -before * r_.com.x, before, before * r_.rod_joint.z, -before * r_.rod_joint.x;
    phase(0.0, v, impact);                      // up to where K moves no more
    if (after != 0.0) phase(after, v, impact);  // and back
    return impact;
  }

 private:
  double particle() const { return r_.reduced_rod_mass > 0.0 ? r_.reduced_rod_mass : 1e-300; }

  /// Until the turning rate is `until`, with K sliding in one direction.
  void phase(double until, Eigen::Matrix<double, 5, 1>& v, RigidImpact& impact) const {
    const Eigen::Vector2d slide = contact_ * v;
    double direction = slide.x();  // of the sliding in this phase
    if (std::abs(v[2]) < 1e-9) {
      // K rests. It begins to slide as a smooth tool would push it; friction holds it where that is within its cone.
      const Change smooth = perImpulse(0.0);
      direction = (contact_ * smooth.v).x();
      const Change rubbed = perImpulse(-r_.friction * sign(direction));
      if (rubbed.v[2] * smooth.v[2] <= 0.0) {
        impact.sticks = true;
        return;
      }
    }
    if (r_.striking_point.z == 0.0) direction = 0.0;  // not even rounding slides
    const Change change = perImpulse(-r_.friction * sign(direction));
    const double impulse = (until - v[2]) / change.v[2];
    const Eigen::Matrix<double, 5, 1> next = v + impulse * change.v;
    const Eigen::Vector2d tool{-r_.friction * sign(direction) * impulse, impulse};
    const Eigen::Vector2d mean = 0.5 * contact_ * (v + next);
    impact.tool += tool;
    impact.hull -= impulse * change.at_d;
    impact.energy -= tool.y() * mean.y();
    impact.friction_work -= tool.x() * mean.x();
    v = next;
  }

  struct Change {
    Eigen::Matrix<double, 5, 1> v;  ///< of the velocities
    Eigen::Vector2d at_d;           ///< impulse BY the hull ON the rocker at D
  };
  /// Per newton second of the tool along z, with so much along x: 5 equations of motion, 4 of the pins.
  Change perImpulse(double along_x) const {
    Eigen::Matrix<double, 9, 9> a = Eigen::Matrix<double, 9, 9>::Zero();
    a.topLeftCorner<5, 5>() = mass_.asDiagonal();
    a.topRightCorner<5, 4>() = -pins_.transpose();
    a.bottomLeftCorner<4, 5>() = pins_;
    Eigen::Matrix<double, 9, 1> right = Eigen::Matrix<double, 9, 1>::Zero();
    right.head<5>() = contact_.transpose() * Eigen::Vector2d(along_x, 1.0);
    const Eigen::Matrix<double, 9, 1> solved = a.fullPivLu().solve(right);
    return {solved.head<5>(), solved.segment<2>(5)};
  }
  static double sign(double value) { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; }

  StrikingRocker r_;
  Eigen::Matrix<double, 5, 1> mass_;
  Eigen::Matrix<double, 4, 5> pins_;
  Eigen::Matrix<double, 2, 5> contact_;
};

/// Transfer function of the rocker just before (the smaller root) and after the blow, from the loop's velocity and
/// acceleration along the line in which all pins lie: l2 v = l3 u - l1, l1 + l2 v^2 = l3 u^2.
inline double transferAtBlow(const HammerParameters& p, bool after) {
  const double l1 = p.lengths.crank, l2 = p.lengths.rod, l3 = p.lengths.rocker;
  // l1 l2 + (l3 u - l1)^2 = l2 l3 u^2
  const double a = l3 * (l3 - l2), b = -l1 * l3, c = l1 * (l1 + l2);
  const double root = std::sqrt(b * b - a * c);
  const double first = (-b + root) / a, second = (-b - root) / a;
  return after ? std::max(first, second) : std::min(first, second);
}

}  // namespace hammer_loads::test
