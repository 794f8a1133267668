// Laws of mechanics that every machine must obey, on a hundred thousand random ones.
#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <complex>
#include <limits>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/linkage/pin_forces.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "property/draw.h"

namespace hammer_loads {
namespace {

using Complex = std::complex<double>;
using test::Draw;
using test::kMachines;

constexpr int kQuadratureMachines = 2000;
constexpr Complex kI{0.0, 1.0};

Complex complex(Planar a) { return {a.re, a.im}; }

/// Largest of many errors, with the index of its machine.
struct Worst {
  double error{};
  int machine{-1};
  void take(double candidate, int i) {
    if (candidate <= error) return;  // a NaN is kept
    error = candidate;
    machine = i;
  }
};

TEST(RandomMachines, LoopStaysClosedAndLinksKeepTheirLengths) {
  Draw draw(1);
  Worst loop, rod, rate, unit;
  for (int i = 0; i < kMachines; ++i) {
    const Mechanism mechanism = test::mechanismOf(draw.parameters());
    const LinkLengths& l = mechanism.linkage().lengths();
    const LinkMotion m = linkMotion(mechanism.linkage(), draw.angle());
    const Complex b = l.crank * complex(m.phi), c = l.pivot_distance + l.rocker * complex(m.psi);
    const double size = l.pivot_distance + l.rocker;
    loop.take(std::abs(b + l.rod * complex(m.beta) - c) / size, i);
    rod.take(std::abs(std::abs(c - b) - l.rod) / size, i);
    for (Planar direction : {m.phi, m.beta, m.psi}) unit.take(std::abs(std::abs(complex(direction)) - 1.0), i);
    // Derivative of the loop by the crank angle: i l1 e^(i phi) + i l2 v e^(i beta) = i l3 u e^(i psi).
    const Complex closing = b + m.v * l.rod * complex(m.beta) - m.rocker.u * l.rocker * complex(m.psi);
    rate.take(std::abs(closing) / (l.crank + l.rod * std::abs(m.v) + l.rocker * std::abs(m.rocker.u)), i);
  }
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();  // some twenty operations
  EXPECT_LE(loop.error, kRounding) << loop.machine;
  EXPECT_LE(rod.error, kRounding) << rod.machine;
  EXPECT_LE(unit.error, kRounding) << unit.machine;
  EXPECT_LE(rate.error, kRounding) << rate.machine;
}

/// Momentum and kinetic energy from the mass and motion of each link.
struct Links {
  Complex momentum;       ///< mechanism frame [N s]
  double kinetic_energy;  ///< [J]
};

Links linksOf(const Mechanism& mechanism, CrankAngle angle, double speed) {
  const HammerParameters& p = mechanism.parameters();
  const LinkMotion m = linkMotion(mechanism.linkage(), angle);
  const Complex crank{p.crank_com_along, p.crank_com_across}, rod{p.rod_com_along, p.rod_com_across};
  const Complex rocker = std::polar(p.rocker_com_distance, p.rocker_com_angle);
  const Complex crank_rate = speed * kI * complex(m.phi), rod_rate = m.v * speed * kI * complex(m.beta),
                rocker_rate = m.rocker.u * speed * kI * complex(m.psi);
  const Complex v1 = crank * crank_rate, v2 = p.lengths.crank * crank_rate + rod * rod_rate, v3 = rocker * rocker_rate;
  Links links;
  links.momentum = p.crank_mass * v1 + p.rod_mass * v2 + p.rocker_mass * v3;
  const double rocker_about_com =
      p.rocker_inertia_about_pivot - p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance;
  links.kinetic_energy =
      0.5 * (p.crank_mass * std::norm(v1) + p.rod_mass * std::norm(v2) + p.rocker_mass * std::norm(v3) +
             p.crank_inertia_about_com * std::norm(crank_rate) + p.rod_inertia_about_com * std::norm(rod_rate) +
             rocker_about_com * std::norm(rocker_rate));
  return links;
}

/// Returns the power of the links' weight [W] for a momentum in the mechanism frame (model.md 1: a reflection).
double weightPower(const Mechanism& mechanism, Complex momentum, Gravity gravity) {
  const double c = mechanism.cosComAngle(), s = mechanism.sinComAngle();
  return -(c * momentum.real() + s * momentum.imag()) * gravity.x +
         (c * momentum.imag() - s * momentum.real()) * gravity.z;
}

TEST(RandomMachines, DrivePowerIsTheRateOfEnergyLessThePowerOfWeight) {
  Draw draw(2);
  Worst from_pins, from_shaft;
  for (int i = 0; i < kMachines; ++i) {
    const Mechanism mechanism = test::mechanismOf(draw.parameters());
    CrankMotion crank = draw.crank();
    crank.speed += std::copysign(1.0, crank.speed);
    const Gravity gravity = draw.gravity();
    const double h = 2e-4 / std::max(std::abs(crank.speed), std::sqrt(std::abs(crank.acceleration)));  // [s]
    crank.angle.offset *= 0.999;  // the stencil stays within half a revolution
    const auto energy = [&](double t) {
      CrankAngle angle = crank.angle;
      angle.offset += t * (crank.speed + 0.5 * t * crank.acceleration);
      return linksOf(mechanism, angle, crank.speed + t * crank.acceleration).kinetic_energy;
    };
    const double rate = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
    const Links links = linksOf(mechanism, crank.angle, crank.speed);
    const double weight = weightPower(mechanism, links.momentum, gravity);
    const double expected = rate - weight;
    const double size = std::abs(rate) + std::abs(weight) + std::abs(crank.speed) * links.kinetic_energy;
    const double pins =
        pinForces(mechanism, Level::kLinkage, crank, gravity, NearBlow(0.01)).drive_torque * crank.speed;
    const double shaft = crank.speed * test::driveTorque(shaftLoad(mechanism, Level::kLinkage, crank.angle, gravity),
                                                         crank.speed, crank.acceleration);
    // Pin forces lose digits near the blow, as the sine of half the crank angle vanishes.
    const double sine = std::abs(std::sin(0.5 * crank.angle.offset));
    from_pins.take(std::abs(pins - expected) / size * std::min(1.0, 100.0 * sine), i);
    from_shaft.take(std::abs(shaft - expected) / size, i);
  }
  // Steps of at most 2e-4 rad: rounding of the difference some 1e-12, truncation (2e-4/0.1)^4 times a derivative.
  EXPECT_LE(from_pins.error, 2e-10) << from_pins.machine;
  EXPECT_LE(from_shaft.error, 2e-10) << from_shaft.machine;
}

TEST(RandomMachines, ImpulseIsMinusTheChangeOfMomentum) {
  Draw draw(3);
  std::array<Worst, 2> force, moment;
  using Quadrature = boost::math::quadrature::gauss<double, 20>;
  for (int i = 0; i < kQuadratureMachines; ++i) {
    const Mechanism mechanism = test::mechanismOf(draw.parameters());
    for (const Level level : {Level::kRocker, Level::kLinkage}) {
      // 0.25 rad on one side of the blow, at a varying speed.
      const double speed = draw.between(5.0, 60.0), acceleration = draw.between(-500.0, 500.0);
      const double start = draw.index(2) == 0 ? draw.between(0.0, 2.6) : draw.between(-3.1, -0.5);
      const double duration = 0.25 / speed;
      const auto crankAt = [&](double t) {
        const Side side = start < 0.0 ? Side::kBeforeBlow : Side::kAfterBlow;
        return CrankMotion{
            {start + t * (speed + 0.5 * t * acceleration), side}, speed + t * acceleration, acceleration};
      };
      const auto impulse = [&](double HullWrench::*component) {
        double sum = 0.0;  // in pieces, since the sharpest machine changes within some 0.1 rad
        constexpr int kPieces = 4;
        for (int k = 0; k < kPieces; ++k) {
          sum +=
              Quadrature::integrate([&](double t) { return hullWrench(mechanism, level, crankAt(t), {}).*component; },
                                    duration * k / kPieces, duration * (k + 1) / kPieces);
        }
        return sum;
      };
      const CrankMotion from = crankAt(0.0), to = crankAt(duration);
      const LinkMomentum before = linkMomentum(mechanism, level, from.angle, from.speed);
      const LinkMomentum after = linkMomentum(mechanism, level, to.angle, to.speed);
      const double size = std::hypot(before.x, before.z) + std::hypot(after.x, after.z);
      const double moment_size =
          std::abs(before.about_d) + std::abs(after.about_d) + size * mechanism.linkage().lengths().rocker;
      const auto at = static_cast<std::size_t>(level == Level::kLinkage);
      force[at].take(std::hypot(impulse(&HullWrench::force_x) + after.x - before.x,
                                impulse(&HullWrench::force_z) + after.z - before.z) /
                         size,
                     i);
      moment[at].take(std::abs(impulse(&HullWrench::torque_y) + after.about_d - before.about_d) / moment_size, i);
    }
  }
  for (std::size_t level : {0U, 1U}) {
    EXPECT_LE(force[level].error, 1e-11) << level << ' ' << force[level].machine;
    EXPECT_LE(moment[level].error, 1e-11) << level << ' ' << moment[level].machine;
  }
}

TEST(RandomMachines, MasslessCrankAndRodLeaveLevelRocker) {
  Draw draw(4);
  Worst wrench, momentum, pins, shaft;
  for (int i = 0; i < kMachines; ++i) {
    HammerParameters p = draw.parameters();
    p.crank_mass = p.rod_mass = p.crank_inertia_about_com = p.rod_inertia_about_com = 0.0;
    const Mechanism mechanism = test::mechanismOf(p);
    const CrankMotion crank = draw.crank();
    const Gravity gravity = draw.gravity();
    const HullWrench a = hullWrench(mechanism, Level::kRocker, crank, gravity);
    const HullWrench b = hullWrench(mechanism, Level::kLinkage, crank, gravity);
    const Motion m = motion(mechanism.linkage(), crank.angle);
    const double psi_accel = m.du * crank.speed * crank.speed + m.u * crank.acceleration;
    const double force = mechanism.rockerFirstMoment() *
                             (m.u * m.u * crank.speed * crank.speed + std::abs(m.du * crank.speed * crank.speed) +
                              std::abs(m.u * crank.acceleration)) +
                         p.rocker_mass * 9.81;
    const double torque = p.rocker_inertia_about_pivot * std::abs(psi_accel) + force * p.rocker_com_distance;
    wrench.take(std::hypot(a.force_x - b.force_x, a.force_z - b.force_z) / force, i);
    wrench.take(std::abs(a.torque_y - b.torque_y) / torque, i);
    const LinkMomentum c = linkMomentum(mechanism, Level::kRocker, crank.angle, crank.speed);
    const LinkMomentum d = linkMomentum(mechanism, Level::kLinkage, crank.angle, crank.speed);
    momentum.take(std::hypot(c.x - d.x, c.z - d.z) / (std::hypot(c.x, c.z) + 1e-300), i);
    const PinReactions poor = pinForces(mechanism, Level::kRocker, crank, gravity, NearBlow(0.01));
    const PinReactions rich = pinForces(mechanism, Level::kLinkage, crank, gravity, NearBlow(0.01));
    const double size = force + std::hypot(poor.rod_on_rocker.x, poor.rod_on_rocker.z);
    pins.take(
        std::hypot(poor.rod_on_rocker.x - rich.rod_on_rocker.x, poor.rod_on_rocker.z - rich.rod_on_rocker.z) / size, i);
    const ShaftLoad e = shaftLoad(mechanism, Level::kRocker, crank.angle, gravity);
    const ShaftLoad f = shaftLoad(mechanism, Level::kLinkage, crank.angle, gravity);
    shaft.take(std::abs(e.inertia - f.inertia) / e.inertia, i);
  }
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
  EXPECT_LE(wrench.error, kRounding) << wrench.machine;
  EXPECT_LE(momentum.error, kRounding) << momentum.machine;
  EXPECT_LE(pins.error, kRounding) << pins.machine;
  EXPECT_LE(shaft.error, kRounding) << shaft.machine;
}

}  // namespace
}  // namespace hammer_loads
