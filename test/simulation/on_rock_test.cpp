// Hull standing on rock: statics by hand, and the limits of a unilateral contact.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kPress = 4000.0, kSettled = 8.0;  ///< [N], [s]

MachineSettings onRock(double stiffness) {
  MachineSettings m = workingMo100();
  m.hammer.drive_reaction_ratio = 1.0;
  m.drive.stop_time = 1e9;
  m.on_boom.on = true;
  m.on_boom.rock = {stiffness, 3.0, kPress};
  for (JointMotion& joint : m.boom) joint.amplitude = 0.0;
  return m;
}

MachineSettings atRest(double stiffness) {
  MachineSettings m = onRock(stiffness);
  m.drive.start_time = 1e9;
  m.start_angle = 1e-9;  // the rocker rests on the tool
  return m;
}

double cross(PlanePoint r, PlanePoint f) { return r.imag() * f.real() - r.real() * f.imag(); }

/// The tolerance covers the change of the weight's lever arms by the lift.
TEST(OnRock, StandsStillWithTheHoldDownForce) {
  HammerOnBoom machine(atRest(3e7));
  for (int i = 0; i < 50; ++i) {
    machine.advanceTo(kSettled + 0.02 * i);
    const OnBoomTruth t = machine.truth();
    ASSERT_NEAR(t.rock.force_z, kPress, 0.05 * kPress) << t.time;
    ASSERT_LT(t.rates.norm(), 1e-4);
  }
}

/// Loads of joints and of a cut of the boom by a force at the foot, with lever arms by hand.
TEST(OnRock, LoadsCylindersAndSections) {
  HammerOnBoom pressed(atRest(3e7));
  pressed.advanceTo(kSettled);
  const OnBoomTruth t = pressed.truth();
  MachineSettings without = atRest(0.0);
  for (int k = 0; k < 3; ++k) without.boom[static_cast<std::size_t>(k + 1)].mean = t.angles[k];
  HammerOnBoom hanging(without);
  hanging.advanceTo(kSettled);
  const OnBoomTruth free = hanging.truth();
  EXPECT_EQ(free.rock.force_z, 0.0);
  const double q1 = t.angles[0], q2 = q1 + t.angles[1], q3 = q2 + t.angles[2];
  const PlanePoint arm = std::polar(2.60, -q1), bracket = arm + std::polar(1.70, -q2);
  const PlanePoint foot = bracket + std::polar(1.0, -q3) * PlanePoint(0.10 - 0.1975, -0.55 - 0.36);
  const PlanePoint force = std::polar(1.0, -q3) * PlanePoint(t.rock.force_x, t.rock.force_z);
  EXPECT_NEAR(t.hold[0] - free.hold[0], -cross(foot, force), 0.02 * kPress);
  EXPECT_NEAR(t.hold[1] - free.hold[1], -cross(foot - arm, force), 0.02 * kPress);
  EXPECT_NEAR(t.hold[2] - free.hold[2], -cross(foot - bracket, force), 0.02 * kPress);
  // The boom cylinder's rod is beyond the cut at 0.50 m.
  const OilBoom boom = oilBoomEo2621();
  const PlanePoint rod = std::polar(1.0, -q1) * boom.cylinders[0].rod, base = boom.cylinders[0].base;
  const PlanePoint push = (t.hold[0] - free.hold[0]) / boom.cylinders[0].arm(q1) * (rod - base) / std::abs(rod - base);
  const PlanePoint cut = std::polar(1.0, -q1) * boom.cuts[0].place;
  EXPECT_NEAR(t.cut[0].torque_y - free.cut[0].torque_y, cross(foot - cut, force) + cross(rod - cut, push),
              0.02 * kPress);
}

TEST(OnRock, NeverPullsAndLetsGoAtEachRecoil) {
  HammerOnBoom machine(onRock(1e8));
  int off = 0, landings = 0;
  double mean = 0.0, before = 0.0;
  constexpr int kFirst = 3000, kLast = 8000;  // [ms]
  for (int i = kFirst; i < kLast; ++i) {
    machine.advanceTo(0.001 * i);
    const double force = machine.truth().rock.force_z;
    ASSERT_GE(force, 0.0);
    off += force == 0.0, landings += force > 0.0 && before == 0.0;
    mean += force / (kLast - kFirst), before = force;
  }
  const auto blows = static_cast<int>(machine.takeBlows().size());
  EXPECT_GT(off, (kLast - kFirst) / 4);
  EXPECT_GE(landings, blows / 2);
  EXPECT_GT(mean, 0.5 * kPress);
  EXPECT_LT(mean, 1.2 * kPress);
}

/// A fifth of the step gives the same result, so that landings are resolved.
TEST(OnRock, StepsAreShortEnough) {
  MachineSettings m = onRock(1e8);
  m.drive.start_time = 0.2;
  MachineSettings fine = m;
  fine.on_boom.step = 2.5e-5;
  HammerOnBoom as_shipped(m), finely(fine);
  double square = 0.0, size = 0.0;
  for (int i = 1; i < 2000; ++i) {
    as_shipped.advanceTo(0.001 * i), finely.advanceTo(0.001 * i);
    const Eigen::Vector3d a = as_shipped.truth().hold, b = finely.truth().hold;
    square += (a - b).squaredNorm(), size += b.squaredNorm();
  }
  EXPECT_LT(std::sqrt(square / size), 0.01);
}

}  // namespace
}  // namespace hammer_loads::simulation
