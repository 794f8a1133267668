/// A boom that an operator moves freely, with independent equations: planar Newton-Euler, cylinder triangles as complex
/// numbers, Stribeck seal friction. Its sensor readings contain the sensors' errors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "boom/booms.h"
#include "hammer_loads/calibration/boom_calibration.h"
#include "hammer_loads/simulation/oil_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::test {

/// Moves from position to position, one joint at a time.
class OperatorMotion {
 public:
  OperatorMotion(std::mt19937& random, double seconds) {
    std::array<double, 3> at{-0.2, 1.2, -0.9};
    for (double time = 0.5; time < seconds;) {
      const std::size_t joint = moves_.size() % 3;
      const auto [low, high] = kRange[joint];
      const bool up = at[joint] < 0.5 * (low + high);
      const double to =
          up ? between(random, 0.5 * (low + high) + 0.1, high) : between(random, low, 0.5 * (low + high) - 0.1);
      const double lasts = between(random, 2.0, 5.0);
      moves_.push_back({joint, time, lasts, at[joint], to});
      at[joint] = to, time += lasts + 0.3;
    }
  }

  /// Returns position, velocity and acceleration of a joint [rad], [rad/s], [rad/s2].
  std::array<double, 3> at(std::size_t joint, double time) const {
    std::array<double, 3> now{};
    bool first = true;
    for (const Move& m : moves_) {
      if (m.joint != joint || (m.begins > time && !first)) continue;
      first = false;
      const double s = std::clamp((time - m.begins) / m.lasts, 0.0, 1.0), way = m.to - m.from;
      now = {m.from + way * (s - std::sin(kTwoPi * s) / kTwoPi), way / m.lasts * (1.0 - std::cos(kTwoPi * s)),
             way / (m.lasts * m.lasts) * kTwoPi * std::sin(kTwoPi * s)};
    }
    return now;
  }

 private:
  struct Move {
    std::size_t joint;
    double begins, lasts, from, to;
  };
  static constexpr std::array<std::array<double, 2>, 3> kRange{{{-0.7, 0.4}, {0.6, 2.1}, {-1.7, -0.1}}};
  std::vector<Move> moves_;
};

struct FreeBoom {
  PlanarChain<3> chain;  ///< boom, arm, bracket with hull
  std::array<simulation::OilCylinder, 3> cylinders;
  std::array<double, 3> friction{};               ///< friction force over the cylinder's force [-]
  std::array<double, 3> friction_force{};         ///< [N]
  std::array<double, 3> zero{};                   ///< [rad]
  std::array<double, 3> offset{};                 ///< of the bore's pressure sensor [Pa]
  std::array<double, 3> gain{};                   ///< of both pressure sensors, minus one [-]
  double joint_rate{50.0}, pressure_rate{100.0};  ///< [Hz]
  double joint_noise{2e-4}, pressure_noise{2e4};  ///< [rad], [Pa]

  /// Has the nominal values of the shipped description and boom file.
  FreeBoom() {
    const simulation::OilBoom given = simulation::oilBoomEo2621();
    for (std::size_t k = 0; k < 3; ++k) {
      const simulation::OilBoomLink& link = given.links[k];
      chain.links[k] = {link.to_next, link.com, link.mass, link.inertia};
    }
    cylinders = given.cylinders;
  }

  /// Draws errors of masses, centres and sensors as a drawing and a fitter make them, and low to high seal friction.
  static FreeBoom drawn(std::mt19937& random) {
    std::normal_distribution<> normal;
    FreeBoom boom;
    for (std::size_t k = 0; k < 3; ++k) {
      auto& link = boom.chain.links[k];
      link.mass *= 1.0 + 0.1 * normal(random), link.inertia *= 1.0 + 0.1 * normal(random);
      link.com += std::complex<double>(0.03 * normal(random), 0.03 * normal(random));
      boom.friction[k] = between(random, 0.0, 0.05);
      boom.friction_force[k] = between(random, 0.0, 0.016) * 14e6 * boom.cylinders[k].bore_area;
      boom.zero[k] = 0.005 * normal(random), boom.offset[k] = 5e4 * normal(random),
      boom.gain[k] = 0.003 * normal(random);
    }
    return boom;
  }

  /// Adds a point mass to the hull at x + i z from D in the hull's axes.
  void hang(double mass, std::complex<double> at) {
    auto& hull = chain.links[2];
    const std::complex<double> from_joint = hull.to_next + at, way = from_joint - hull.com;
    hull.inertia += hull.mass * mass / (hull.mass + mass) * std::norm(way);
    hull.com += mass / (hull.mass + mass) * way;
    hull.mass += mass;
  }

  /// Returns the joint torques due to weight [N m].
  std::array<double, 3> staticTorque(const std::array<double, 3>& q) const { return chain.loads(q, {}, {}, 0.0, 0.0); }

  double rubbing(std::size_t k, double force, double speed) const {
    constexpr double kStribeck = 0.004, kSmooth = 2e-4;  // [m/s]
    const double more = 1.0 + 0.4 * std::exp(-std::pow(speed / kStribeck, 2));
    return (friction_force[k] + friction[k] * std::abs(force)) * more * std::tanh(speed / kSmooth);
  }

  calibration::BoomRecording record(std::mt19937& random, double seconds) const {
    const OperatorMotion motion(random, seconds);
    std::normal_distribution<> normal;
    calibration::BoomRecording recording;
    recording.joint.resize(4), recording.pressure.resize(3);
    for (double t = 0.0; t < seconds; t += 1.0 / joint_rate) {
      for (std::size_t k = 0; k < 3; ++k) {
        recording.joint[k + 1].time.push_back(t);
        recording.joint[k + 1].value.push_back(motion.at(k, t)[0] + zero[k] + joint_noise * normal(random));
      }
    }
    for (double t = 0.0; t < seconds; t += 1.0 / pressure_rate) {
      std::array<double, 3> q{}, qd{}, qdd{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<double, 3> now = motion.at(k, t);
        q[k] = now[0], qd[k] = now[1], qdd[k] = now[2];
      }
      const std::array<double, 3> load = chain.loads(q, qd, qdd, 0.0, 0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const simulation::OilCylinder& c = cylinders[k];
        const double arm = c.arm(q[k]), force = -load[k] / arm, oil = force + rubbing(k, force, arm * qd[k]);
        const double back =
            8e5 + 4e5 * std::sin(0.7 * t + static_cast<double>(k));  // back pressure of the valve in the other chamber
        const double bore = oil > 0.0 ? (oil + back * c.rod_area) / c.bore_area : back;
        const double rod = oil > 0.0 ? back : (back * c.bore_area - oil) / c.rod_area;
        for (std::size_t chamber = 0; chamber < 2; ++chamber) {
          calibration::Trace& trace = recording.pressure[k][chamber];
          const double pressure = chamber == 0 ? bore : rod;
          trace.time.push_back(t);
          trace.value.push_back(pressure * (1.0 + gain[k]) + (chamber == 0 ? offset[k] : 0.0) +
                                pressure_noise * normal(random));
        }
      }
    }
    return recording;
  }
};

inline calibration::BoomBasis shippedBasis() {
  calibration::BoomBasis basis;
  basis.urdf = shippedUrdf();
  basis.parameters = shippedBoomParameters();
  basis.g_B = kLevel;
  return basis;
}

}  // namespace hammer_loads::test
