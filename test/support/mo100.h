/// The hammer MO-100 (P0) and random hammers for tests.
#pragma once

#include <cmath>
#include <random>
#include <stdexcept>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::test {

constexpr double kPaperSpeed = 31.416;  ///< [rad/s], P0

/// P0's figures; crank and rod massless; an arbitrary drive inertia.
inline HammerParameters mo100Parameters() {
  HammerParameters p;
  p.lengths = {0.048, 0.150, 0.120, 0.078};
  p.rocker_com_distance = 0.106;
  p.rocker_com_angle = 50.0 * kPi / 180.0;
  p.rocker_mass = 35.2;
  p.rocker_inertia_about_pivot = 0.737;
  p.striking_distance = 0.737 / (35.2 * 0.106);
  p.drive_inertia = 0.5;
  return p;
}

/// With the crank and rod of reference mo100_linkage.csv.
inline HammerParameters mo100LinkageParameters() {
  HammerParameters p = mo100Parameters();
  p.crank_mass = 6.0;
  p.crank_com_along = 0.010;
  p.crank_com_across = 0.002;
  p.crank_inertia_about_com = 0.02;
  p.rod_mass = 4.5;
  p.rod_com_along = 0.070;
  p.rod_com_across = -0.004;
  p.rod_inertia_about_com = 0.012;
  return p;
}

inline Mechanism mechanismOf(const HammerParameters& p) {
  const Checked<Mechanism> made = Mechanism::make(p);
  if (!made.value) throw std::runtime_error(made.problems.front());
  return *made.value;
}

/// A hammer with pivot distance and rocker 1.15 to 4 crank lengths, of any size from 5 to 500 mm crank.
inline HammerParameters randomParameters(std::mt19937& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  HammerParameters p;
  const double l1 = std::exp(between(std::log(0.005), std::log(0.5)));
  const double l0 = l1 * between(1.15, 4.0), l3 = l1 * between(1.15, 4.0);
  p.lengths = {l1, l0 + l3 - l1, l3, l0};
  p.rocker_com_distance = l3 * between(0.3, 1.5);
  p.rocker_com_angle = between(-kPi, kPi);
  p.rocker_mass = between(1.0, 100.0);
  p.rocker_inertia_about_pivot = p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance * between(1.0, 2.5);
  p.striking_distance = l3 * between(0.5, 2.0);
  p.striking_friction = between(0.0, 0.5);
  p.crank_mass = p.rocker_mass * between(0.0, 0.5);
  p.crank_com_along = l1 * between(-1.0, 1.0);
  p.crank_com_across = l1 * between(-0.3, 0.3);
  p.crank_inertia_about_com = p.crank_mass * l1 * l1 * between(0.1, 1.0);
  p.rod_mass = p.rocker_mass * between(0.0, 0.5);
  p.rod_com_along = p.lengths.rod * between(-0.2, 1.2);
  p.rod_com_across = p.lengths.rod * between(-0.3, 0.3);
  p.rod_inertia_about_com = p.rod_mass * p.lengths.rod * p.lengths.rod * between(0.02, 0.2);
  p.drive_inertia = p.rocker_inertia_about_pivot * between(0.1, 2.0);
  return p;
}

/// Drive torque on the crank, about hull +y, that gives it an acceleration, without motor and flywheel [N m].
inline double driveTorque(const ShaftLoad& load, double speed, double acceleration) {
  return load.inertia * acceleration + load.half_inertia_slope * speed * speed - load.weight_torque;
}

}  // namespace hammer_loads::test
