// Crank and rocker with an elastic connecting rod, against the simulated machine's own equations, energy and the rigid
// mechanism.
#include "hammer_loads/linkage/two_bodies.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/simulation/elastic_links.h"
#include "hammer_loads/simulation/machine_settings.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kJc = 0.6, kTorque = 150.0;
constexpr Gravity kWeight{2.0, -9.5};

/// Returns a hammer whose rod has no rotational inertia about its centre of mass; for it both rod models are the same.
HammerParameters heavy() {
  HammerParameters p = simulation::workingMo100().hammer;
  p.crank_mass = 6.0, p.crank_com_along = 0.015, p.crank_com_across = 0.004, p.crank_inertia_about_com = 0.01;
  p.rod_mass = 4.5, p.rod_com_along = 0.070, p.rod_com_across = -0.004;
  return p;
}

/// Returns psi of the rocker [rad].
double rockerOf(const TwoBodies& bodies, const TwoBodyState& s) {
  const Motion m = bodies.links(s.angle).rocker;
  return std::atan2(m.sin_psi, m.cos_psi) + s.displacement;
}

TEST(TwoBodies, AccelerationsAndWrenchAreThoseOfFreeLinks) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const simulation::ElasticLinks links(mechanism.parameters(), Level::kLinkage);
  const RodSpring rod{1e9, 0.3, 0.0};
  const simulation::RodSpring spring({rod.stiffness, rod.damping_ratio, 0.0});
  for (const double offset : {-0.2, -0.03, 0.02, 0.15, 0.7, 1.9}) {
    TwoBodyState s{CrankAngle::fromOffset(offset), 14.0, 1e-5, 0.8};
    const LinkMotion l = bodies.links(s.angle);
    const simulation::TwoBodies angles{offset, rockerOf(bodies, s)},
        speeds{s.speed, l.rocker.u * s.speed + s.displacement_rate};
    const simulation::ElasticLinks::View view = links.at(angles, speeds);
    const double tension = spring.tension(view.rod.stretch, view.rod.rate(speeds));
    const auto weight = links.weight(view, kWeight), inertia = links.inertiaOfSpeeds(view);
    auto M = links.inertia(view);
    M[0] += kJc;
    const double on_crank = kTorque + weight[0] + inertia[0] - tension * view.rod.slope[0];
    const double on_rocker = weight[1] + inertia[1] - tension * view.rod.slope[1];
    const double det = M[0] * M[2] - M[1] * M[1];
    const simulation::TwoBodies expected{(M[2] * on_crank - M[1] * on_rocker) / det,
                                         (M[0] * on_rocker - M[1] * on_crank) / det};
    const TwoBodyAccelerations a = bodies.accelerations(rod, {kJc, kTorque, kWeight}, s, l);
    const double scale = std::abs(expected[0]) + std::abs(expected[1]);
    EXPECT_NEAR(a.crank, expected[0], 1e-3 * scale) << offset;  // terms in x^2 and in x times the speeds are neglected
    EXPECT_NEAR(a.rocker, expected[1], 1e-3 * scale) << offset;
    const simulation::Load load = links.load(view, expected, kWeight, 0.0);
    const HullWrench wrench = hullWrenchOf(mechanism, l, bodies.linkAccelerations(s, a, l), kWeight);
    const double force = std::abs(load.force_x) + std::abs(load.force_z);
    EXPECT_NEAR(wrench.force_x, load.force_x, 2e-3 * force) << offset;
    EXPECT_NEAR(wrench.force_z, load.force_z, 2e-3 * force) << offset;
    EXPECT_NEAR(wrench.torque_y, load.torque_y, 2e-3 * std::abs(load.torque_y) + 1e-3 * force) << offset;
  }
}

/// Far from the rigid position, where a blow on elastic rock throws the rocker, the rod pulls at the crank as well.
TEST(TwoBodies, AStepFollowsTheAccelerations) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const TwoBodyDrive drive{kJc, kTorque, kWeight};
  constexpr double kStep = 1e-6;  // [s]
  for (const double play : {0.0, 1e-4})
    for (const double displacement : {-0.05, -0.01, 0.02, 0.05}) {
      const RodSpring rod{1e9, 0.3, play};
      const TwoBodyState from{CrankAngle::fromOffset(0.15), 20.0, displacement, -8.0};
      TwoBodyState s = from;
      bodies.move(rod, drive, kStep, s);
      const LinkMotion before = bodies.links(from.angle), after = bodies.links(s.angle);
      const auto rocker = [](const LinkMotion& l, const TwoBodyState& of) {
        return l.rocker.u * of.speed + of.displacement_rate;
      };
      const TwoBodyAccelerations a = bodies.accelerations(rod, drive, from, before);
      const double scale = 1e-3 * (std::abs(a.crank) + std::abs(a.rocker));
      EXPECT_NEAR((s.speed - from.speed) / kStep, a.crank, scale) << displacement;
      EXPECT_NEAR((rocker(after, s) - rocker(before, from)) / kStep, a.rocker, scale) << displacement;
    }
}

/// Returns the energy of drive, links and spring [J], by the simulated machine's links.
double energyOf(const TwoBodies& bodies, const simulation::ElasticLinks& links, double stiffness,
                const TwoBodyState& s) {
  const LinkMotion l = bodies.links(s.angle);
  const simulation::TwoBodies angles{s.angle.offset, rockerOf(bodies, s)},
      v{s.speed, l.rocker.u * s.speed + s.displacement_rate};
  const simulation::ElasticLinks::View view = links.at(angles, v);
  auto M = links.inertia(view);
  return 0.5 * ((M[0] + kJc) * v[0] * v[0] + M[2] * v[1] * v[1]) + M[1] * v[0] * v[1] +
         simulation::RodSpring({stiffness, 0.0, 0.0}).energy(view.rod.stretch);
}

/// Energy is conserved without drive, weight and damping.
TEST(TwoBodies, AVibrationKeepsItsEnergy) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const simulation::ElasticLinks links(mechanism.parameters(), Level::kLinkage);
  const RodSpring rod{1e9, 0.0, 0.0};
  const auto drift = [&](double part) {
    TwoBodyState s{{0.003, Side::kAfterBlow}, 14.0, -2e-3, -1.5};
    const double before = energyOf(bodies, links, rod.stiffness, s);
    double worst = 0.0;
    for (double time = 0.0; time < 0.04; time += part) {
      bodies.move(rod, {kJc, 0.0, {}}, part, s);
      worst = std::max(worst, std::abs(energyOf(bodies, links, rod.stiffness, s) - before));
    }
    return worst;
  };
  EXPECT_LT(drift(1e-5), 0.15);   // [J] of 70; the third order of the stretch in x is neglected
  EXPECT_LT(drift(2.5e-4), 0.3);  // step of the filter
}

/// Each pin dissipates its moment r |T| times the rotation of the links that it joins, by differences of their angles.
TEST(TwoBodies, FrictionDissipatesTheWorkOfThePins) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const simulation::ElasticLinks links(mechanism.parameters(), Level::kLinkage);
  const LinkLengths& l = mechanism.linkage().lengths();
  const auto anglesOf = [&](const TwoBodyState& s) {  // crank, rocker and rod from pin to pin [rad]
    const LinkMotion rigid = bodies.links(s.angle);
    const Planar pivots = l.crank * rigid.phi + l.rod * rigid.beta - l.rocker * rigid.psi;
    const LinkMotion at = withRocker(rigid, s.displacement);
    const Planar rod = pivots + l.rocker * at.psi - l.crank * at.phi;
    return std::array<double, 3>{std::atan2(at.phi.im, at.phi.re), std::atan2(at.psi.im, at.psi.re),
                                 std::atan2(rod.im, rod.re)};
  };
  for (const double step : {2e-5, 5e-4}) {
    const RodSpring spring{1e9, 0.0, 0.0, 1e-3};
    TwoBodyState s{{0.003, Side::kAfterBlow}, 14.0, -2e-3, -1.5};
    const double before = energyOf(bodies, links, spring.stiffness, s);
    double work = 0.0;
    for (double time = 0.0; time < 0.03; time += step) {
      const auto from = anglesOf(s);
      const auto tension = [&] {
        return std::abs(bodies.accelerations(spring, {kJc, 0.0, {}}, s, bodies.links(s.angle)).tension);
      };
      const double here = tension();
      bodies.move(spring, {kJc, 0.0, {}}, step, s);
      const auto to = anglesOf(s);
      const auto turned = [&](std::size_t i) { return CrankAngle::wrapToPi(to[i] - from[i]); };
      work += spring.friction_radius * 0.5 * (here + tension()) *
              (std::abs(turned(0)) + std::abs(turned(1)) + std::abs(turned(2) - turned(0)) +
               std::abs(turned(2) - turned(1)));
    }
    EXPECT_GT(work, 2.0) << step;
    EXPECT_NEAR(before - energyOf(bodies, links, spring.stiffness, s), work, 0.1 * work) << step;
  }
}

TEST(TwoBodies, AStiffRodIsTheRigidMechanism) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const ShaftModel model(mechanism, Level::kLinkage);
  for (const double ratio : {0.1, 3.0, 300.0}) {
    const RodSpring rod{1e13, ratio, 0.0};
    const TwoBodyDrive drive{kJc, kTorque, {}};
    TwoBodyState s{{0.3, Side::kAfterBlow}, 15.0, 0.0, 0.0};
    bodies.settle(rod, drive, s);
    ShaftState rigid;
    rigid.position = {0, s.angle};
    rigid.speed = s.speed, rigid.torque = kTorque, rigid.drive_inertia = kJc;
    for (int i = 0; i < 40; ++i) bodies.move(rod, drive, 5e-4, s);
    advanceState(model, 0.02, {}, rigid);
    EXPECT_NEAR(s.angle.offset, rigid.position.angle.offset, 1e-5) << ratio;
    EXPECT_NEAR(s.speed, rigid.speed, 1e-3) << ratio;
    EXPECT_LT(std::abs(s.displacement), 1e-5) << ratio;
  }
}

/// The rate at which the links lose momentum in ten microseconds is the wrench without weight. This also holds a
/// fiftieth of a radian beside the rigid position.
TEST(TwoBodies, MomentumIsWhatTheWrenchTakes) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const RodSpring rod{3e7, 0.3, 0.0};
  const TwoBodyDrive drive{kJc, kTorque, kWeight};
  const auto linksOf = [&](const TwoBodyState& s) {
    LinkMotion links = bodies.links(s.angle);
    links.psi = links.psi * Planar{std::cos(s.displacement), std::sin(s.displacement)};
    return links;
  };
  const auto momentum = [&](const TwoBodyState& s) {
    return -1.0 * hullWrenchOf(mechanism, linksOf(s), bodies.linkSpeeds(s, linksOf(s)), {0.0, 0.0});
  };
  for (const double displacement : {1e-5, 0.02}) {
    TwoBodyState s{CrankAngle::fromOffset(0.3), 14.0, displacement, 3.0};
    const LinkMotion links = linksOf(s);
    const TwoBodyAccelerations a = bodies.accelerations(rod, drive, s, bodies.links(s.angle));
    const HullWrench wrench = hullWrenchOf(mechanism, links, bodies.linkAccelerations(s, a, links), {0.0, 0.0});
    const HullWrench before = momentum(s);
    constexpr double kTime = 1e-5;
    bodies.move(rod, drive, kTime, s);
    const HullWrench lost = (1.0 / kTime) * (before + -1.0 * momentum(s));
    const double size = std::hypot(wrench.force_x, wrench.force_z);
    EXPECT_NEAR(lost.force_x, wrench.force_x, 0.01 * size) << displacement;
    EXPECT_NEAR(lost.force_z, wrench.force_z, 0.01 * size) << displacement;
    EXPECT_NEAR(lost.torque_y, wrench.torque_y, 0.01 * std::abs(wrench.torque_y) + 0.002 * size) << displacement;
  }
}

/// At the tool the rocker's speed reverses, the crank keeps its momentum, and the position is continuous.
TEST(TwoBodies, ABlowActsOnTheRockerAlone) {
  const Mechanism mechanism = test::mechanismOf(heavy());
  const TwoBodies bodies(mechanism);
  const RodSpring rod{1e9, 0.3, 0.0};
  const TwoBodyDrive drive{kJc, 0.0, {}};
  TwoBodyState s{{-1e-4, Side::kBeforeBlow}, 14.0, 0.0, 0.0};
  const double before = bodies.links(s.angle).rocker.u * s.speed;
  TwoBodies::LinksMemo memo;
  const std::optional<TwoBodies::Blow> blow = bodies.moveToTool(rod, drive, {0.0, 0.16}, 2e-5, s, memo);
  ASSERT_EQ(s.angle.side, Side::kAfterBlow);
  ASSERT_TRUE(blow);
  EXPECT_NEAR(blow->time, 1e-4 / 14.0, 1e-8);
  EXPECT_NEAR(rockerOf(bodies, blow->before), 0.0, 1e-7);
  EXPECT_EQ(blow->before.angle.side, Side::kBeforeBlow);
  EXPECT_NEAR(rockerOf(bodies, blow->after), 0.0, 1e-7);
  TwoBodyState later = s;
  EXPECT_FALSE(bodies.moveToTool(rod, drive, {0.0, 0.16}, 2e-5, later, memo)) << "it is behind it";
  EXPECT_NEAR(bodies.links(s.angle).rocker.u * s.speed + s.displacement_rate, -0.16 * before, 1e-2);
  EXPECT_NEAR(rockerOf(bodies, s), 0.0, 1e-3);
  TwoBodyState early{{-1e-4, Side::kBeforeBlow}, 14.0, 0.0, 0.0};
  bodies.strikeEarly(drive, {0.0, 0.16}, early);
  bodies.move(rod, drive, 2e-5, early);
  EXPECT_NEAR(early.angle.offset, s.angle.offset, 1e-9);
  EXPECT_NEAR(early.displacement, s.displacement, 1e-7);
  EXPECT_NEAR(early.speed, s.speed, 1e-4);
}

}  // namespace
}  // namespace hammer_loads
