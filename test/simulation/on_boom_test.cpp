// Hull and boom on oil: against the machine with a hull at rest, against statics by hand, and readings of the sensors.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/simulation/session.h"
#include "simulation/boom_run.h"

namespace hammer_loads::simulation {
namespace {

using test::onBoom;

constexpr double kGravity = 9.80665;

void holdStill(MachineSettings& m) {
  for (JointMotion& joint : m.boom) joint.amplitude = 0.0;
}

/// Returns a boom with natural frequencies 50 times as high, 0.2 to 1.4 kHz, so that it is nearly at rest.
MachineSettings onSteel() {
  MachineSettings m = onBoom();
  holdStill(m);
  m.drive.start_time = 0.2;
  m.on_boom.oil_stiffness = 2500.0;
  m.on_boom.step = 5e-5;
  return m;
}

TEST(OnBoom, OilAsStiffAsSteelIsAHullAtRest) {
  const MachineSettings m = onSteel();
  HammerOnBoom on_oil(m);
  WorkingMachine at_rest(m);
  double peak = 0.0, worst = 0.0, drive = 0.0, worst_drive = 0.0;
  for (int i = 1; i <= 1900; ++i) {
    on_oil.advanceTo(0.001 * i);
    at_rest.advanceTo(0.001 * i);
    const OnBoomTruth a = on_oil.truth();
    const CrankTruth b = at_rest.truth();
    if (std::abs(std::remainder(b.angle, 6.283185307179586)) < 0.3) continue;  // the blow excites the stiff oil too
    peak = std::max(peak, std::abs(b.load.force_z)), drive = std::max(drive, std::abs(b.drive_reaction_y));
    worst = std::max(worst, std::abs(a.load.force_z - b.load.force_z));
    worst_drive = std::max(worst_drive, std::abs(a.drive_reaction_y - b.drive_reaction_y));
  }
  const auto blows = on_oil.takeBlows(), blows_at_rest = at_rest.takeBlows();
  ASSERT_EQ(blows.size(), blows_at_rest.size());
  ASSERT_GT(blows.size(), 2U);
  for (std::size_t i = 0; i < blows.size(); ++i) {
    EXPECT_NEAR(blows[i].time, blows_at_rest[i].time, 2e-4);
    EXPECT_NEAR(blows[i].strike.energy / blows_at_rest[i].strike.energy, 1.0, 0.01);
    EXPECT_NEAR(blows[i].strike.rocker_speed_before / blows_at_rest[i].strike.rocker_speed_before, 1.0, 0.01);
  }
  EXPECT_LT(worst, 0.02 * peak);
  EXPECT_LT(worst_drive, 0.02 * drive);
}

/// Masses and positions of the links are those of the robot description.
TEST(OnBoom, HoldsItsWeightAtRest) {
  MachineSettings m = onBoom();
  holdStill(m);
  m.drive.start_time = 100.0;
  m.boom[1].mean = -0.45, m.boom[2].mean = 1.0, m.boom[3].mean = -0.5;
  HammerOnBoom machine(m);
  machine.advanceTo(0.01);
  const double q1 = -0.45, q2 = 0.55, q3 = 0.05;
  const auto x_of = [](double q, double x, double z) { return x * std::cos(q) + z * std::sin(q); };
  const double arm_at = x_of(q1, 2.60, 0.0), hull_at = arm_at + x_of(q2, 1.70, 0.0);
  const double bracket_and_hull = 50.0 * x_of(q3, 0.03, -0.06) + 350.0 * x_of(q3, 0.02, -0.50);
  const double about_boom = kGravity * (400.0 * x_of(q1, 1.20, 0.08) + 230.0 * (arm_at + x_of(q2, 0.70, 0.06)) +
                                        400.0 * hull_at + bracket_and_hull);
  EXPECT_NEAR(machine.truth().hold[0], -about_boom, 0.005 * about_boom) << "but for the rocker's place";
}

TEST(OnBoom, RestitutionIsTheToolsSpeedOverTheRockers) {
  MachineSettings m = onSteel();
  m.blow.restitution_drawn = true, m.blow.restitution_low = m.blow.restitution_high = 0.25;
  HammerOnBoom machine(m);
  machine.advanceTo(1.9);
  const MovingLinks links(*Mechanism::make(m.hammer).value, Level::kRocker);
  for (const BlowTruth& blow : machine.takeBlows()) {
    const Strike at_rest = links.strike(blow.crank_speed, 0.25, m.drive.inertia);
    EXPECT_NEAR(-blow.strike.rocker_speed_after / blow.strike.rocker_speed_before, 0.25, 0.01);
    EXPECT_NEAR(blow.strike.crank_speed_after / at_rest.crank_speed_after, 1.0, 0.02);
    EXPECT_NEAR(blow.strike.energy / at_rest.energy, 1.0, 0.02);
    EXPECT_GT(blow.strike.linkage_loss, 0.0);
  }
}

TEST(OnBoomSession, GivesEqualReadingsForOneSeedHoweverTimeIsCut) {
  MachineSettings m = onBoom();
  m.on_boom.imu.acceleration_noise = 0.1, m.on_boom.pressures.noise = 1e4, m.joint_noise = 1e-4;
  m.duration = 2.0;
  const Session whole = recordSession(m);
  SessionStream stream(m);
  Session pieces;
  for (int i = 1; i <= 400; ++i) stream.advanceTo(0.005 * i, pieces);
  ASSERT_EQ(whole.imu.size(), 1000U);
  ASSERT_EQ(whole.pressures.size(), 200U);
  ASSERT_EQ(whole.joints.size(), 100U);
  ASSERT_EQ(whole.on_boom.size(), whole.crank.size());
  ASSERT_EQ(pieces.imu.size(), whole.imu.size());
  for (std::size_t i = 0; i < whole.imu.size(); ++i) {
    ASSERT_EQ(whole.imu[i].stamp, pieces.imu[i].stamp);
    ASSERT_NEAR(whole.imu[i].specific_force[2], pieces.imu[i].specific_force[2], 1e-3);
    ASSERT_NEAR(whole.imu[i].specific_force[1], pieces.imu[i].specific_force[1], 1e-12) << "noise alone";
  }
  const Session again = recordSession(m);
  for (std::size_t i = 0; i < whole.pressures.size(); ++i) {
    ASSERT_EQ(whole.pressures[i].bore, again.pressures[i].bore);
    ASSERT_EQ(whole.pressures[i].rod, again.pressures[i].rod);
  }
  for (std::size_t i = 0; i < whole.joints.size(); ++i) ASSERT_EQ(whole.joints[i].position, again.joints[i].position);
}

/// The unit is rotated by 0.3 rad. The difference of the chambers' forces holds the joint.
TEST(OnBoomSession, SensorsAtRestShowTheWeight) {
  MachineSettings m = onBoom();
  holdStill(m);
  m.duration = 0.2;
  m.start_angle = 1e-9;
  m.joint_speed_noise = 0.01;
  const Session session = recordSession(m);
  const auto& q = session.joints.back().position;
  const double pitch = q[1] + q[2] + q[3] + 0.3;
  for (const HullImuReading& imu : session.imu) {
    ASSERT_NEAR(imu.specific_force[0], -kGravity * std::sin(pitch), 0.3);
    ASSERT_NEAR(imu.specific_force[2], kGravity * std::cos(pitch), 0.3);
  }
  const OilCylinder boom = oilBoomEo2621().cylinders[0];
  const PressureReading& p = session.pressures.back();
  const double push = boom.bore_area * p.bore[0] - boom.rod_area * p.rod[0];
  EXPECT_NEAR(push * boom.arm(q[1]), session.on_boom.back().hold[0], 0.01 * std::abs(session.on_boom.back().hold[0]));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(std::min(p.bore[i], p.rod[i]), 5e6, 0.05e6);
  double squares = 0.0;
  for (const JointReading& joints : session.joints)
    for (const double speed : joints.velocity)
      squares += speed * speed / (4.0 * static_cast<double>(session.joints.size()));
  EXPECT_NEAR(std::sqrt(squares), 0.01, 0.004);
}

/// The joint sensors measure the operator's pose and the vibration about it.
TEST(OnBoomSession, JointSensorsSeeTheVibration) {
  MachineSettings m = onBoom();
  m.joint_rate = 400.0;
  const Session session = recordSession(m);
  double largest = 0.0;
  for (const JointReading& joints : session.joints) {
    const double time = 1e-9 * static_cast<double>(joints.stamp - m.start_stamp);
    largest = std::max(largest, std::abs(joints.position[1] - positionOf(m.boom[1], time)));
    ASSERT_NEAR(joints.position[0], positionOf(m.boom[0], time), 1e-12) << "the swing is held";
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(largest, 1e-2);
}

/// Seals oppose the motion of their rods. The force that holds a joint differs from that of the pressures by theirs.
TEST(OnBoom, SealsRubAndOnlyTakeEnergy) {
  const OilBoom boom = oilBoomEo2621();
  for (const double friction : {0.0, 0.03}) {
    MachineSettings m = onBoom();
    m.on_boom.seals.friction = friction;
    HammerOnBoom machine(m);
    double taken = 0.0, most = 0.0;
    int moving = 0;
    for (int i = 1; i <= 3000; ++i) {
      machine.advanceTo(1e-3 * i);
      const OnBoomTruth t = machine.truth();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto j = static_cast<int>(k);
        const OilCylinder& c = boom.cylinders[k];
        const double arm = c.arm(t.angles[j]), speed = arm * t.rates[j];
        const double oil = c.bore_area * t.bore_pressure[k] - c.rod_area * t.rod_pressure[k];
        const double rubbing = t.hold[j] / arm - oil;  // force BY the seals ON the rod
        ASSERT_LE(rubbing * speed, 1e-6) << i;
        ASSERT_LE(std::abs(rubbing), 1.4 * friction * std::abs(oil) + 1e-6) << i;
        taken -= rubbing * speed * 1e-3, most = std::max(most, std::abs(rubbing));
        if (std::abs(speed) < 0.01) continue;
        ++moving;
        ASSERT_NEAR(rubbing, std::copysign(friction * std::abs(oil), -speed), 0.01 * friction * std::abs(oil) + 1e-6);
      }
    }
    EXPECT_GT(moving, 100);
    EXPECT_EQ(taken > 1.0, friction > 0.0) << taken;  // [J]
    EXPECT_EQ(most > 500.0, friction > 0.0) << most;  // [N]
  }
}

/// Seals with a constant friction and 0.05 mm of presliding. Their friction never exceeds the Stribeck curve, is full
/// once the rod has slid ten times as far in one direction, and hardly changes just after a reversal.
TEST(OnBoom, SealsYieldBeforeTheySlide) {
  constexpr double kYielding = 5e-5, kConstant = 0.013;
  const OilBoom boom = oilBoomEo2621();
  MachineSettings m = onBoom();
  m.on_boom.seals.constant = kConstant, m.on_boom.seals.presliding = kYielding;
  HammerOnBoom machine(m);
  std::array<double, 3> slid{}, before{};  // slide in one direction [m]; friction a step earlier [N]
  double taken = 0.0;
  int full = 0, turns = 0;
  for (int i = 1; i <= 20000; ++i) {
    machine.advanceTo(1e-4 * i);
    const OnBoomTruth t = machine.truth();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto j = static_cast<int>(k);
      const OilCylinder& c = boom.cylinders[k];
      const double arm = c.arm(t.angles[j]), step = 1e-4 * arm * t.rates[j], size = kConstant * 14e6 * c.bore_area;
      const double rubbing = t.hold[j] / arm - c.bore_area * t.bore_pressure[k] + c.rod_area * t.rod_pressure[k];
      ASSERT_LE(std::abs(rubbing), 1.4 * size + 1e-6) << i;
      taken -= rubbing * step;
      const bool turned = slid[k] * step < 0.0;
      if (turned && std::abs(slid[k]) > 10.0 * kYielding && std::abs(step) < 0.1 * kYielding) {
        ++turns;
        ASSERT_GT(rubbing * before[k], 0.0) << i;
      }
      slid[k] = turned ? step : slid[k] + step, before[k] = rubbing;
      if (std::abs(slid[k]) < 10.0 * kYielding || std::abs(step) < 2e-6) continue;
      ++full;
      ASSERT_NEAR(rubbing, std::copysign(size, -step), 0.01 * size) << i;
    }
  }
  EXPECT_GT(full, 100);
  EXPECT_GT(turns, 3);
  EXPECT_GT(taken, 1.0);  // [J]
}

}  // namespace
}  // namespace hammer_loads::simulation
