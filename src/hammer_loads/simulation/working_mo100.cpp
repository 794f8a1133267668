#include <cmath>

#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

/// Returns the MO-100 of P0, in which crank and rod are massless.
HammerParameters mo100() {
  HammerParameters p;
  p.lengths = {0.048, 0.150, 0.120, 0.078};
  p.rocker_com_distance = 0.106;
  p.rocker_com_angle = 50.0 * kDegree;
  p.rocker_mass = 35.2;
  p.rocker_inertia_about_pivot = 0.737;
  p.striking_distance = 0.737 / (35.2 * 0.106);  // percussion centre
  p.drive_inertia = 0.6;
  return p;
}

/// Returns a drive chosen for 1000 J at 4.65 blows per second: a motor of 104 cm3 at 11 MPa.
DriveSettings drive() {
  DriveSettings d;
  d.motor_displacement = 1.65e-5;
  d.compliance = 1.9e-11;
  d.leakage = 2.0e-12;
  d.relief_pressure = 11.1e6;
  d.relief_slope = 3.0e-10;
  d.coulomb_friction = 13.0;
  d.viscous_friction = 0.12;
  d.friction_speed = 0.05;
  d.inertia = 0.6;
  d.flow = 5.2e-4;
  d.flow_variation = 0.012;
  d.flow_variation_period = 13.0;
  d.ripple = 0.01;
  d.ripple_frequency = 270.0;
  d.start_time = 1.4;
  d.start_ramp = 0.8;
  d.stop_time = 18.0;
  d.stop_ramp = 0.1;
  d.bypass = 1.5e-9;
  return d;
}

}  // namespace

double positionOf(const JointMotion& motion, double time) noexcept {
  if (motion.amplitude == 0.0) return motion.mean;
  return motion.mean + motion.amplitude * std::sin(2.0 * kPi * time / motion.period + motion.phase);
}

double velocityOf(const JointMotion& motion, double time) noexcept {
  if (motion.amplitude == 0.0) return 0.0;
  const double rate = 2.0 * kPi / motion.period;
  return motion.amplitude * rate * std::cos(rate * time + motion.phase);
}

double hullPitch(const MachineSettings& settings, double time) noexcept {
  double pitch = 0.0;
  for (std::size_t i = 1; i < settings.boom.size(); ++i) pitch += positionOf(settings.boom[i], time);
  return pitch;
}

Gravity hullGravity(const MachineSettings& settings, double time) noexcept {
  const double pitch = hullPitch(settings, time);
  return {settings.gravity * std::sin(pitch), -settings.gravity * std::cos(pitch)};
}

MachineSettings workingMo100() {
  MachineSettings s;
  s.hammer = mo100();
  s.drive = drive();
  s.crank.rate = 1000.0;
  s.crank.jitter = 3e-5;
  s.crank.counts = 4096;
  s.crank.speed_noise = 0.15;
  s.boom = {
      {{0.20, 0.030, 31.0, 0.0}, {-0.54, 0.040, 14.0, 0.0}, {1.20, 0.035, 11.0, 0.4}, {-0.66, 0.045, 17.0, -0.3}}};
  s.joint_rate = 50.0;
  s.gravity = 9.80665;
  s.start_angle = 1.0;
  s.duration = 20.0;
  s.step = 5e-4;
  s.start_stamp = 1700000000000000000;
  s.seed = 1;
  return s;
}

}  // namespace hammer_loads::simulation
