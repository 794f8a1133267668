/// Hull and mechanism as one free planar system, by other means than the code under test.
///
/// Coordinates: position of the hull's point D, tilt about +y, crank angle. Every body's place follows from them by the
/// simulated machine's loop closure; mass matrix and inertia forces come from the derivatives of the places along the
/// motion, found by automatic differentiation. No formula of relative motion or momentum theorem is used.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/simulation/moving_links.h"

namespace hammer_loads::test {

struct HullBody {
  double mass{400.0};    ///< without the moving links [kg]
  double inertia{60.0};  ///< about its centre of mass, without motor and flywheel [kg m2]
  double com_x{0.05};    ///< hull axes, from D [m]
  double com_z{0.30};
  double gravity{9.80665};
  /// Spring and damper at D towards D = 0 and tilt = 0, along inertial x, z and about +y: the boom.
  Eigen::Vector3d stiffness{0.0, 0.0, 0.0};  ///< [N/m], [N m/rad]
  Eigen::Vector3d damping{0.0, 0.0, 0.0};    ///< [N s/m], [N m s/rad]
};

struct FreeState {
  Eigen::Vector3d hull{0.0, 0.0, 0.0};  ///< inertial x and z (up) of D [m], tilt about +y [rad]
  Eigen::Vector3d hull_rate{0.0, 0.0, 0.0};
  CrankAngle crank;
  double crank_speed{};  ///< relative to the hull [rad/s]
};

class FreeHull {
 public:
  struct Result {
    Eigen::Vector4d acceleration;  ///< of x, z, tilt, crank angle
    HullMotion hull;               ///< as it is
    /// On the hull by links, stator and nothing else, from Newton for the hull alone: hull axes, moment about D.
    double force_x, force_z, moment;
    double flywheel_torque;  ///< accelerates motor and flywheel, part of the stator's torque [N m]
  };

  FreeHull(const Mechanism& mechanism, Level level, const HullBody& body)
      : links_(mechanism, level), hammer_(mechanism.parameters()), body_(body) {}

  /// Under the drive's torque on the crank, its stator on the hull [N m].
  Result at(const FreeState& state, double torque) const {
    Eigen::Matrix4d mass = Eigen::Matrix4d::Zero();
    Eigen::Vector4d force(0.0, 0.0, 0.0, torque);
    force.head<3>() -= body_.stiffness.cwiseProduct(state.hull) + body_.damping.cwiseProduct(state.hull_rate);
    const Bodies bodies = bodiesAt(state.crank);
    for (std::size_t b = 0; b < bodies.count; ++b) {
      const Relative& body = bodies.body[b];
      std::array<Place, 4> by;
      for (int i = 0; i < 4; ++i) by[static_cast<std::size_t>(i)] = place(body, state.hull, Eigen::Vector4d::Unit(i));
      const Place moving = place(body, state.hull, rates(state));
      for (int i = 0; i < 4; ++i) {
        const Place& p = by[static_cast<std::size_t>(i)];
        force[i] -= body.mass * (p.x.first * moving.x.second + p.z.first * (moving.z.second + body_.gravity)) +
                    body.inertia * p.angle.first * moving.angle.second;
        for (int k = 0; k < 4; ++k) {
          const Place& q = by[static_cast<std::size_t>(k)];
          mass(i, k) += body.mass * (p.x.first * q.x.first + p.z.first * q.z.first) +
                        body.inertia * p.angle.first * q.angle.first;
        }
      }
    }
    Result out;
    out.acceleration = mass.ldlt().solve(force);
    newtonForHull(state, out);
    return out;
  }

  /// What all forces and moments on one link must add up to: m (a - g) in hull axes, moment about its centre of mass.
  struct Demand {
    Gravity force;
    double moment;
    double com_x, com_z;  ///< hull axes, from D
  };
  /// Of the rocker and, at level linkage, crank and rod.
  std::array<Demand, 3> demands(const FreeState& state, const Result& result) const {
    std::array<Demand, 3> out{};
    const Bodies bodies = bodiesAt(state.crank);
    for (std::size_t b = 2; b < bodies.count; ++b) {
      const Relative& body = bodies.body[b];
      const Place p = place(body, state.hull, rates(state), result.acceleration);
      out[b - 2] = {toHull(state, body.mass * p.x.second, body.mass * (p.z.second + body_.gravity)),
                    body.inertia * p.angle.second, body.x.value, body.z.value};
    }
    return out;
  }

 private:
  using Jet = simulation::Jet;
  /// Centre of mass in hull axes and angle about +y relative to the hull, by the crank angle.
  struct Relative {
    double mass, inertia;
    Jet x, z, angle;
  };
  struct Bodies {
    std::array<Relative, 5> body;
    std::size_t count;
  };
  /// Inertial, along the motion.
  struct Place {
    Jet x, z, angle;
  };

  static Eigen::Vector4d rates(const FreeState& s) {
    return {s.hull_rate[0], s.hull_rate[1], s.hull_rate[2], s.crank_speed};
  }

  Bodies bodiesAt(CrankAngle angle) const {
    const simulation::LinkBodies links = links_.at({angle.offset, angle.side == Side::kBeforeBlow});
    const double a = hammer_.rocker_com_angle, c = std::cos(a), s = std::sin(a), l0 = hammer_.lengths.pivot_distance;
    Bodies all{{}, 0};
    all.body[all.count++] = {body_.mass, body_.inertia, {body_.com_x, 0, 0}, {body_.com_z, 0, 0}, {}};
    all.body[all.count++] = {0.0, hammer_.drive_inertia, {c * l0, 0, 0}, {s * l0, 0, 0}, {angle.offset, 1.0, 0.0}};
    for (const simulation::LinkBodies::Body* at = links.body; at != links.body + links.count; ++at) {
      const simulation::LinkBodies::Body& link = *at;
      const Jet xi = link.xi + -l0;
      all.body[all.count++] = {link.mass, link.inertia_about_com, (-c) * xi + (-s) * link.eta, (-s) * xi + c * link.eta,
                               link.angle};
    }
    return all;
  }

  static Place place(const Relative& body, const Eigen::Vector3d& hull, const Eigen::Vector4d& rate,
                     const Eigen::Vector4d& acceleration = Eigen::Vector4d::Zero()) {
    const auto inTime = [&](const Jet& f) {
      return Jet{f.value, f.first * rate[3], f.second * rate[3] * rate[3] + f.first * acceleration[3]};
    };
    const Jet tilt{hull[2], rate[2], acceleration[2]}, x = inTime(body.x), z = inTime(body.z);
    return {Jet{hull[0], rate[0], acceleration[0]} + x * cos(tilt) + z * sin(tilt),
            Jet{hull[1], rate[1], acceleration[1]} + z * cos(tilt) - x * sin(tilt), tilt + inTime(body.angle)};
  }

  /// Inertial vector to hull axes.
  static Gravity toHull(const FreeState& state, double x, double z) {
    const double c = std::cos(state.hull[2]), s = std::sin(state.hull[2]);
    return {x * c - z * s, x * s + z * c};
  }

  void newtonForHull(const FreeState& state, Result& out) const {
    const double rate = state.hull_rate[2], alpha = out.acceleration[2];
    out.hull = {toHull(state, -out.acceleration[0], -body_.gravity - out.acceleration[1]), rate, alpha};
    // Acceleration less gravity of the hull's centre of mass.
    const double ax = alpha * body_.com_z - rate * rate * body_.com_x - out.hull.gravity.x;
    const double az = -alpha * body_.com_x - rate * rate * body_.com_z - out.hull.gravity.z;
    const Eigen::Vector3d boom =
        -body_.stiffness.cwiseProduct(state.hull) - body_.damping.cwiseProduct(state.hull_rate);
    const Gravity boom_force = toHull(state, boom[0], boom[1]);
    out.force_x = body_.mass * ax - boom_force.x;
    out.force_z = body_.mass * az - boom_force.z;
    out.moment = body_.inertia * alpha + body_.mass * (body_.com_z * ax - body_.com_x * az) - boom[2];
    out.flywheel_torque = hammer_.drive_inertia * (out.acceleration[3] + alpha);
  }

  simulation::MovingLinks links_;
  HammerParameters hammer_;
  HullBody body_;
};

}  // namespace hammer_loads::test
