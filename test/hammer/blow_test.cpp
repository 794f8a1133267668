#include "hammer_loads/hammer/blow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

TEST(Blow, GivesAThousandJouleForThePapersHammerAtNameplateSpeed) {
  // model.md 1, 6: R = 0.1753; 13.6 rad/s for 1000 J; 31.416 rad/s brings 5476 J, of which the rebound keeps R^2.
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const RockerBlow nominal = blowAtCrankSpeed(mechanism, Level::kRocker, 31.416);
  EXPECT_NEAR(nominal.restitution, 0.1753, 5e-5);
  EXPECT_NEAR(0.5 * 0.737 * nominal.rocker_speed_before * nominal.rocker_speed_before, 5476.0, 1.0);
  EXPECT_NEAR(nominal.energy, 5476.2 * (1.0 - 0.1753 * 0.1753), 1.0);
  EXPECT_NEAR(blowAtCrankSpeed(mechanism, Level::kRocker, 13.64).energy, 1000.0, 2.0);
  // The upward impulse on the hull in a revolution equals the tool's impulse (model.md 4).
  EXPECT_NEAR(nominal.tool_impulse_z, 534.602622037, 1e-8);
}

/// The impulse on the hull is that of the tool less the change of the links' momenta.
TEST(Blow, ChangesTheMomentaOfAllLinksByTheMeasuredImpulses) {
  HammerParameters parameters = test::mo100LinkageParameters();
  parameters.drive_reaction_ratio = 0.5;
  for (const auto& [offset, friction] : {std::pair(0.0, 0.0), std::pair(0.02, 0.0), std::pair(-0.03, 0.4)}) {
    parameters.striking_offset = offset, parameters.striking_friction = friction;
    const Mechanism mechanism = test::mechanismOf(parameters);
    for (const double factor : {0.7, 0.976, 1.1}) {
      const RockerBlow b = measuredBlow(mechanism, Level::kLinkage, {13.0, 0.1, factor, 0.01, 0.6, 0.02});
      const LinkMomentum from = linkMomentum(mechanism, Level::kLinkage, {0.0, Side::kBeforeBlow}, 13.0);
      const LinkMomentum to = linkMomentum(mechanism, Level::kLinkage, {0.0, Side::kAfterBlow}, 13.0 * factor);
      const double by_tool = offset * b.tool_impulse_x + parameters.striking_distance * b.tool_impulse_z;
      EXPECT_NEAR(to.x - from.x, b.tool_impulse_x - b.support_impulse_x, 1e-9);
      EXPECT_NEAR(to.z - from.z, b.tool_impulse_z - b.support_impulse_z, 1e-9);
      EXPECT_NEAR(to.about_d - from.about_d, by_tool - b.support_impulse_y, 1e-9);
      EXPECT_NEAR(b.drive_impulse_y, -0.6 * 0.5 * 13.0 * (factor - 1.0), 1e-12);
      EXPECT_GT(b.energy_std, 0.0);
      EXPECT_NEAR(b.restitution_std, 0.01 * 0.94 / 1.95, 3e-3);
    }
  }
}

/// The rod holds the rocker. The tool receives the energy that drive and links lose; the tool's impulse slows both.
TEST(Blow, AToolMetEarlySlowsDriveAndLinksTogether) {
  HammerParameters parameters = test::mo100LinkageParameters();
  parameters.striking_offset = 0.03, parameters.striking_friction = 0.3;
  const Mechanism mechanism = test::mechanismOf(parameters);
  constexpr double kDrive = 0.6, kSpeed = 13.0, kFactor = 0.3;
  const CrankAngle angle{0.0, Side::kBeforeBlow};
  const ShaftLoad load = shaftLoadLinkage(mechanism, linkMotion(mechanism.linkage(), angle), {});
  const double inertia = kDrive + load.inertia, lost = kSpeed * (1.0 - kFactor);
  const RockerBlow b = measuredBlow(mechanism, Level::kLinkage, {kSpeed, 0.1, kFactor, 0.01, kDrive, 0.02, true});
  EXPECT_NEAR(b.energy + b.friction_work, 0.5 * inertia * kSpeed * kSpeed * (1.0 - kFactor * kFactor), 1e-9);
  EXPECT_GT(b.friction_work, 0.0);
  EXPECT_NEAR(std::abs(b.tool_impulse_x), 0.3 * b.tool_impulse_z, 1e-9);
  const double about_d = 0.03 * b.tool_impulse_x + parameters.striking_distance * b.tool_impulse_z;
  EXPECT_NEAR(-motion(mechanism.linkage(), angle).u * about_d, inertia * lost, 1e-9);
  EXPECT_TRUE(std::isnan(b.restitution));
  const double by_speed = 2.0 * 0.1 / kSpeed, by_factor = 2.0 * 0.01 * kFactor / (1.0 - kFactor * kFactor);
  const double by_inertia = 0.02 * kDrive / inertia;
  EXPECT_NEAR(b.energy_std, b.energy * std::hypot(by_speed, by_factor, by_inertia), 0.05 * b.energy_std);
}

TEST(Blow, RodLosesTheEnergyThatTheLinkageLoses) {
  // The crank's speed is constant, so crank and drive keep their kinetic energy. Apart from the rotation about B, the
  // rod's energy changes by the change of its momentum times B's speed.
  HammerParameters p = test::mo100LinkageParameters();
  const Mechanism mechanism = test::mechanismOf(p);
  const double w = 20.0;
  const RockerBlow blow = blowAtCrankSpeed(mechanism, Level::kLinkage, w);
  const auto energy = [&](Side side) {
    return 0.5 * w * w * shaftLoad(mechanism, Level::kLinkage, {0.0, side}, {}).inertia;
  };
  const auto rod_rate = [&](Side side) { return w * linkMotion(mechanism.linkage(), {0.0, side}).v; };
  const double lost = energy(Side::kBeforeBlow) - energy(Side::kAfterBlow);
  const double turn = rod_rate(Side::kAfterBlow) - rod_rate(Side::kBeforeBlow);
  const double rod_inertia = p.rod_inertia_about_com + p.rod_mass * (0.07 * 0.07 + 0.004 * 0.004);
  // Work of the drive through pin B, where the rod's impulse is (m2 rho2 - J2/l2) times its change of rate.
  const double impulse_b = (p.rod_mass * p.rod_com_along - rod_inertia / 0.150) * turn;
  // Through C the rod's end moves with l1 w beside its turning; the reduced mass counts the joint's own speed.
  const double work_b = impulse_b * 0.048 * w;
  EXPECT_NEAR(lost + work_b, blow.energy, 1e-10 * blow.energy);
}

/// Returns a random rocker that strikes at this speed: x_K is opposite in sign to w- = -speed_before.
StrikingRocker randomRocker(std::mt19937& random, double speed_before) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  StrikingRocker r;
  r.mass = between(1.0, 50.0);
  r.inertia_about_pivot = between(0.1, 3.0);
  r.com = {between(-0.2, 0.2), between(-0.2, 0.2)};
  r.rod_joint = {between(-0.2, 0.2), between(-0.2, 0.2)};
  r.reduced_rod_mass = between(0.0, 10.0);
  r.striking_point = {(speed_before < 0.0 ? -1.0 : 1.0) * between(0.1, 0.4), between(-0.05, 0.05)};
  r.friction = between(0.0, 0.5);
  return r;
}

TEST(Blow, HasThePapersSpecialCaseTen) {
  // P1's w- is counter-clockwise in (x, y), so psi' = -w-. (10): com, joint and striking point on the x axis. |I0x| =
  // w(1 - R) J*/|xK| f in the limit of a face that slides back in the rebound (print: 1 + R), I0y = -w(1 + R)(m xC +
  // mn xN - J*/xK); the print of (10) lacks the minus that (9) has.
  const double w = 50.0, restitution = 0.2, f = 0.15;
  StrikingRocker r;
  r.mass = 35.2;
  r.inertia_about_pivot = 0.737;
  r.com = {-0.1, 0.0};
  r.rod_joint = {-0.12, 0.0};
  r.reduced_rod_mass = 2.0;
  r.friction = f;
  const double inertia = 0.737 + 2.0 * 0.12 * 0.12;
  const double factor = w * (1.0 + restitution);
  for (double side : {-1.0, 1.0}) {
    r.striking_point = {-0.2, side * 1e-12};
    const RockerBlow b = blowInSupport(r, -w, restitution * w);
    const double support_on_rocker_x = -b.support_impulse_x, support_on_rocker_z = -b.support_impulse_z;
    EXPECT_NEAR(support_on_rocker_x, -side * w * (1.0 - restitution) * inertia / 0.2 * f, 1e-8);
    EXPECT_NEAR(support_on_rocker_z, -factor * (35.2 * -0.1 + 2.0 * -0.12 - inertia / -0.2), 1e-8);
  }
  r.striking_point.z = 0.0;  // without sliding there is no friction
  EXPECT_EQ(blowInSupport(r, -w, restitution * w).tool_impulse_x, 0.0);
}

TEST(Blow, HasTheCentreOfMassOfThePapersCaseEighteen) {
  // (18): f = 0, yK = 0, massless rod: yC = 0, xC = J/(m xK).
  StrikingRocker r;
  r.mass = 35.2;
  r.inertia_about_pivot = 0.737;
  r.striking_point = {-0.2, 0.0};
  const HullPoint ideal = idealCentreOfMass(r, -50.0, 8.0);
  EXPECT_DOUBLE_EQ(ideal.x, 0.737 / (35.2 * -0.2));
  EXPECT_EQ(ideal.z, 0.0);
}

TEST(Blow, IdealCentreOfMassFreesTheSupportOfAnyRocker) {
  std::mt19937 random(52);
  for (int i = 0; i < 500; ++i) {
    const double before = i % 2 ? -60.0 : 60.0;
    StrikingRocker r = randomRocker(random, before);
    r.com = idealCentreOfMass(r, before, -0.3 * before);
    const RockerBlow b = blowInSupport(r, before, -0.3 * before);
    EXPECT_NEAR(b.support_impulse_x, 0.0, 1e-12 * (b.tool_impulse_z + r.reduced_rod_mass * 60.0));
    EXPECT_NEAR(b.support_impulse_z, 0.0, 1e-12 * (b.tool_impulse_z + r.reduced_rod_mass * 60.0));
  }
}

}  // namespace
}  // namespace hammer_loads
