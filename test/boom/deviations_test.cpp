// Standard deviations compared with machines whose oil is drawn at random, and flags with oil calculated by hand.
#include <gtest/gtest.h>

#include "boom/vibrating_machine.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

using test::kLevel;
using test::kMillisecond;

JointMotion still(const JointVector& position) {
  const JointVector zero = JointVector::Zero(position.size());
  return {position, zero, zero};
}

TEST(Deviations, CoverMachinesWithOilDrawnAtRandom) {
  // The logarithm of a machine's bulk modulus differs from that of the file by a normal error of 0.3.
  std::mt19937 random(61);
  int samples = 0, within = 0;
  double mean_square_error = 0.0, mean_variance = 0.0;
  std::size_t allocations = 0;
  for (int draw = 0; draw < 30; ++draw) {
    const double factor = std::exp(0.3 * std::normal_distribution<>()(random));
    test::VibratingMachine machine(test::shippedBoomParameters(), 1e9 * factor, 1);
    Boom boom = test::shippedBoom();
    boom.moveCompliant(still(test::workingPosition()), kLevel);
    VibrationSpread spread;
    test::PulsingHammer hammer;
    Eigen::Vector3d load = Eigen::Vector3d::Zero();
    JointVector torque = JointVector::Zero(4);
    BoomDeviations deviations;
    for (int i = 0; i < 2500; ++i) {
      const Wrench w = hammer.at(i * kMillisecond);
      const Eigen::Vector3d next = machine.load(w);
      machine.step(load, next);
      load = next;
      const JointVector to = boom.hammerTorque(w);
      const std::size_t before = test::allocations;
      const TorqueStep step{torque, to, 0.5 * (torque + to)};
      spread.follow(boom.vibration());
      boom.vibration().advance(kMillisecond, step);
      spread.advance(kMillisecond, step, boom.spreadTorque({}));
      boom.deviations(spread, {}, false, deviations);
      allocations += test::allocations - before;
      torque = to;
      if (i < 200) continue;
      const JointVector hold = to + boom.vibration().torque();
      for (int j = 0; j < 3; ++j) {
        const double error = std::abs(hold[j + 1] - machine.hold()[j]), deviation = deviations.torque[j + 1];
        ++samples;
        if (error <= 2.0 * deviation) ++within;
        mean_square_error += error * error, mean_variance += deviation * deviation;
      }
    }
  }
  const double covered = static_cast<double>(within) / samples;
  RecordProperty("covered_percent", format("%.1f", 100.0 * covered));
  RecordProperty("deviation_over_error", format("%.2f", std::sqrt(mean_variance / mean_square_error)));
  EXPECT_GE(covered, 0.85);
  EXPECT_LE(covered, 0.99);
  EXPECT_EQ(allocations, 0U);
}

TEST(Deviations, EqualDifferencesOfTheLoads) {
  std::mt19937 random(62);
  Boom boom = test::shippedBoom();
  for (int i = 0; i < 20; ++i) {
    boom.move(still(test::randomPosition(boom.chain(), random)), kLevel);
    const Wrench w = test::randomWrench(random), error = test::randomWrench(random);
    BoomLoads loads, other;
    SteelLoads steel, other_steel;
    boom.loads(w, true, loads), boom.steelLoads(w, true, steel);
    const Wrench moved{w.force + error.force, w.torque + error.torque};
    boom.loads(moved, true, other), boom.steelLoads(moved, true, other_steel);
    BoomDeviations deviations;
    boom.deviations(VibrationSpread(), {1, {error, {}, {}}}, true, deviations);
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(deviations.torque[j], std::abs(other.total[j] - loads.total[j]), 1e-8);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(deviations.cylinder[k], std::abs(other.cylinder[k].force - loads.cylinder[k].force), 1e-7);
      const Eigen::Vector3d by = (other_steel.section[k].torque - steel.section[k].torque).cwiseAbs();
      EXPECT_LT((deviations.section[k].torque - by).norm(), 1e-7);
      const Eigen::Vector3d reaction = (other_steel.joint[k].force - steel.joint[k].force).cwiseAbs();
      EXPECT_LT((deviations.joint[k].force - reaction).norm(), 1e-7);
    }
    // Variances of independent errors add up.
    BoomDeviations twice;
    boom.deviations(VibrationSpread(), {2, {error, error, {}}}, true, twice);
    EXPECT_LT((twice.torque - std::sqrt(2.0) * deviations.torque).norm(), 1e-8);
  }
}

TEST(Deviations, ALastingErrorOfTheLoadIsThatOfAnotherLoad) {
  // The load is 4 % too large at all times. The effect is the difference of two vibrations.
  Boom boom = test::shippedBoom(), larger = boom;
  boom.moveCompliant(still(test::workingPosition()), kLevel);
  larger.moveCompliant(still(test::workingPosition()), kLevel);
  VibrationSpread spread(OilDeviation{0.0, 0.0});
  test::PulsingHammer hammer;
  JointVector torque = JointVector::Zero(4);
  double size = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Wrench w = hammer.at(i * kMillisecond);
    const JointVector to = boom.hammerTorque(w);
    const TorqueStep step{torque, to, 0.5 * (torque + to)};
    const WrenchSpread error{1, {Wrench{0.04 * w.force, 0.04 * w.torque}, {}, {}}};
    spread.follow(boom.vibration());
    boom.vibration().advance(kMillisecond, step);
    spread.advance(kMillisecond, step, boom.spreadTorque(error));
    larger.vibration().advance(kMillisecond, {1.04 * step.from, 1.04 * step.to, 1.04 * step.mean});
    torque = to;
    BoomDeviations deviations;
    boom.deviations(spread, error, false, deviations);
    const JointVector here = to + boom.vibration().torque(), there = 1.04 * to + larger.vibration().torque();
    EXPECT_LT((deviations.torque - (there - here).cwiseAbs()).norm(), 1e-8 * (1.0 + to.norm()));
    size = std::max(size, deviations.torque.maxCoeff());
  }
  EXPECT_GT(size, 100.0);
}

TEST(Deviations, ShrinkWithWhatIsIdentified) {
  Boom truth = test::shippedBoom(), given = truth, identified = truth;
  identified.vibration().identify();
  for (Boom* boom : {&truth, &given, &identified}) boom->moveCompliant(still(test::workingPosition()), kLevel);
  VibrationSpread of_given, of_identified;
  // The push changes its sign every 0.4 s. The joint angles have almost no noise.
  JointVector push = JointVector::Constant(4, 2e3);
  for (int i = 0; i < 4000; ++i) {
    if (i % 400 == 200) push = -push;
    const TorqueStep step{push, push, push};
    of_given.follow(given.vibration()), of_identified.follow(identified.vibration());
    for (Boom* boom : {&truth, &given, &identified}) boom->vibration().advance(kMillisecond, step);
    for (VibrationSpread* spread : {&of_given, &of_identified})
      spread->advance(kMillisecond, step, given.spreadTorque({}));
    for (int j = 1; j < 4; ++j) {
      VibrationReading reading = jointAngleReading(j, truth.vibration().displacement()[j]);
      reading.noise = 1e-5;
      identified.vibration().observe(j, reading);
    }
  }
  BoomDeviations before, after;
  given.deviations(of_given, {}, false, before);
  identified.deviations(of_identified, {}, false, after);
  EXPECT_GT(before.torque.norm(), 100.0);
  EXPECT_LT(after.torque.norm(), 0.3 * before.torque.norm());
}

TEST(Deviations, AreThoseOfTheLoadAloneAtADeadCentre) {
  BoomParameters parameters = test::shippedBoomParameters();
  CylinderParameters& p = parameters.cylinders[0];
  p.base_x = 0.25 - 1.0, p.base_z = 0.40, p.rod_x = 1.0, p.rod_z = 0.0, p.closed_length = 1.5, p.stroke = 0.6;
  Boom boom = *Boom::make(test::shippedUrdf(), parameters).value;
  boom.vibration().identify();
  VibrationSpread spread;
  const WrenchSpread error{1, {Wrench{{100.0, 0.0, 300.0}, {0.0, 50.0, 0.0}}, {}, {}}};
  const JointVector push = JointVector::Constant(4, 1e3);
  for (double angle : {-0.2, 0.0, 0.2}) {  // to the zero moment arm and away from it
    for (int i = 0; i < 20; ++i) {
      boom.moveCompliant(still(test::joints({0.0, angle, 1.0, -1.0})), kLevel);
      spread.follow(boom.vibration());
      boom.vibration().advance(kMillisecond, {push, push, push});
      spread.advance(kMillisecond, {push, push, push}, boom.spreadTorque(error));
      boom.vibration().observe(0, jointAngleReading(1, 1e-4));
    }
    EXPECT_EQ(boom.vibration().known(), angle != 0.0);
    BoomDeviations deviations;
    boom.deviations(spread, error, false, deviations);
    EXPECT_TRUE(deviations.torque.allFinite());
    if (angle != 0.0) continue;
    EXPECT_LT((deviations.torque - boom.hammerTorque(error.part[0]).cwiseAbs()).norm(), 1e-9);
    EXPECT_TRUE(std::isnan(deviations.cylinder[0]));
    EXPECT_TRUE(std::isfinite(deviations.cylinder[1]));
    BoomLoads loads;
    boom.loads({}, false, loads);
    EXPECT_EQ(boom.flags(0, loads), kZeroMomentArm);
  }
}

TEST(CylinderFlags, PressuresAreThoseOfTrappedOil) {
  const Boom boom = test::shippedBoom();
  const Cylinder& c = boom.cylinders()[0];
  const CylinderPosition at = c.at(-0.35);
  // After a steady push of 60 kN, 1e-5 m of shortening changes the pressures of both chambers by B A dL/V.
  const double steady = -60e3 * at.arm, stroke = 1e-5, total = -(60e3 + c.stiffness(at.length) * stroke) * at.arm;
  const ChamberPressures p = chamberPressures(c, at, steady, total);
  const double out = at.length - 0.79, bore = c.boreArea(), rod = c.rodArea();
  EXPECT_NEAR(p.bore, 60e3 / bore + 1e9 * bore * stroke / (0.0008 + bore * out), 1e-3);
  EXPECT_NEAR(p.rod, -1e9 * rod * stroke / (0.0008 + rod * (0.65 - out)), 1e-3);
  EXPECT_NEAR(p.bore * bore - p.rod * rod, -total / at.arm, 1e-6);
  const ChamberPressures pulls = chamberPressures(c, at, -steady, -steady);
  EXPECT_EQ(pulls.bore, 0.0);
  EXPECT_NEAR(pulls.rod, 60e3 / rod, 1e-6);
}

TEST(CylinderFlags, NameEachFault) {
  const Boom boom = test::shippedBoom();
  const Cylinder& c = boom.cylinders()[0];
  const CylinderPosition at = c.at(-0.35);
  const auto flags = [&](double steady, double total) {
    return cylinderFlags(c, at, -steady * at.arm, -total * at.arm);
  };
  EXPECT_EQ(flags(60e3, 60e3), 0);
  EXPECT_EQ(flags(60e3, 60.1e3), 0);
  EXPECT_EQ(flags(60e3, 80e3), kChamberEmpty);  // the rod's chamber expands
  EXPECT_EQ(flags(60e3, 30e3), 0);              // both chambers share the decrease
  EXPECT_EQ(flags(20e3, -30e3) & kForceReversed, kForceReversed);
  EXPECT_EQ(flags(20e3, -60e3) & kChamberEmpty, kChamberEmpty);
  EXPECT_EQ(flags(c.greatestPush(), c.greatestPush()) & kReliefReached, kReliefReached);
  EXPECT_EQ(flags(0.99 * c.greatestPush(), 0.99 * c.greatestPush()), 0);
  EXPECT_EQ(flags(-c.greatestPull(), -c.greatestPull()) & kReliefReached, kReliefReached);
  CylinderPosition dead = at;
  dead.zero_moment_arm = true;
  EXPECT_EQ(cylinderFlags(c, dead, 1e3, 1e3), kZeroMomentArm);
}

TEST(CylinderFlags, TakeTheBoomsWeightAsSteady) {
  Boom boom = test::shippedBoom();
  boom.move(still(test::workingPosition()), kLevel);
  BoomLoads loads;
  boom.loads({}, true, loads);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(boom.flags(i, loads), 0);
  // The hammer lifts the boom against its weight.
  boom.loads({Eigen::Vector3d(0.0, 0.0, 40e3), Eigen::Vector3d::Zero()}, true, loads);
  EXPECT_NE(boom.flags(0, loads) & kForceReversed, 0);
}

}  // namespace
}  // namespace hammer_loads
