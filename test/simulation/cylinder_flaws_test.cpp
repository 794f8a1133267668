// Flaws of cylinders and their sensors: air, leakage, joint clearance; hoses, resolution, bus delay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hammer_loads/simulation/oil_boom.h"
#include "hammer_loads/simulation/session.h"
#include "simulation/boom_run.h"

namespace hammer_loads::simulation {
namespace {

using test::onBoom;

constexpr double kBulk = 1e9, kAir = 0.01;

/// Returns a hammer that never starts, on a boom that the operator swings.
MachineSettings swungBoom() {
  MachineSettings m = onBoom();
  m.drive.start_time = 90.0, m.drive.stop_time = 100.0;
  for (JointMotion& joint : m.boom) joint = {joint.mean, 0.02, 1.0, 0.0};
  return m;
}

/// Returns the volume relative to that at ambient pressure, as the sum of liquid and gas.
double volumeBySum(double absolute) {
  const double liquid = (1.0 - kAir) * (1.0 - (absolute - 1.013e5) / kBulk);
  const double gas = kAir * std::exp(std::log(1.013e5 / absolute) / 1.4);
  return liquid + gas;
}

TEST(ChamberOil, IsLiquidAndGas) {
  const ChamberOil oil(kBulk, kAir);
  for (const double pressure : {2e5, 1e6, 6e6, 2e7}) {
    const double h = 1e-4 * pressure, p = pressure + 1.013e5;
    const double bulk = -volumeBySum(p) * 2.0 * h / (volumeBySum(p + h) - volumeBySum(p - h));
    EXPECT_NEAR(oil.bulkModulus(pressure), bulk, 1e-6 * bulk) << pressure;
    for (const double part : {-2e-3, 1e-3, 1e-2}) {
      const double to = oil.compressed(pressure, part);
      if (to < -1.0e5) continue;  // boils
      EXPECT_NEAR(volumeBySum(to + 1.013e5), (1.0 - part) * volumeBySum(p), 1e-9) << pressure << ' ' << part;
    }
  }
  EXPECT_LT(oil.bulkModulus(5e5), 0.35 * kBulk);
  EXPECT_GT(oil.bulkModulus(2e7), 0.95 * kBulk);
  EXPECT_NEAR(oil.compressed(1e5, -0.5), -1.013e5 + 1e3, 1.0) << "a vacuum";
  EXPECT_NEAR(ChamberOil(kBulk, 0.0).compressed(6e6, 1e-3), 6e6 + 1e6, 6e3);
}

/// Two chambers per cylinder with a negligible leak move as linear springs do, except for the change of geometry.
TEST(CylinderFlaws, ChambersWithoutFlawsAreTheSpringsTheyStandFor) {
  MachineSettings m = onBoom();
  m.on_boom.pressures.preload = 2e7;  // otherwise the oil boils where a rod is pulled out
  m.on_boom.oil_stiffness = 50.0;     // for small displacements
  m.on_boom.step = 1e-4;
  HammerOnBoom springs(m);
  m.on_boom.leak = 1e-30;
  HammerOnBoom chambers(m);
  double largest = 0.0, off = 0.0;
  for (int i = 1; i <= 2500; ++i) {
    springs.advanceTo(1e-3 * i), chambers.advanceTo(1e-3 * i);
    const OnBoomTruth a = springs.truth(), b = chambers.truth();
    largest = std::max(largest, a.displacement.cwiseAbs().maxCoeff());
    off = std::max(off, (a.displacement - b.displacement).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 2e-5);
  EXPECT_LT(off, 0.05 * largest);
  EXPECT_GT(off, 0.0);
}

/// Leakage past a piston dissipates energy, so that the boom comes to rest sooner.
TEST(CylinderFlaws, ALeakTakesEnergyOutOfASwing) {
  std::array<double, 2> left{};
  for (const double leak : {0.0, 2e-11}) {
    MachineSettings m = onBoom();
    m.drive.stop_time = 1.5;
    m.on_boom.damping = 0.01;
    m.on_boom.leak = leak;
    HammerOnBoom machine(m);
    double& most = left[leak > 0.0];
    for (int i = 2600; i <= 3000; ++i) {
      machine.advanceTo(1e-3 * i);
      most = std::max(most, machine.truth().rates.cwiseAbs().maxCoeff());
    }
  }
  EXPECT_LT(left[1], 0.8 * left[0]);
}

/// A force that reverses is zero while the rod passes through the clearance of its pins.
TEST(CylinderFlaws, LoosePinsCarryNothingWithinTheirClearance) {
  const OilBoom boom = oilBoomEo2621();
  std::array<int, 2> idle{};
  std::array<bool, 3> both_ways{};
  for (const double play : {0.0, 3e-4}) {
    MachineSettings m = onBoom();
    m.on_boom.pin_play = play;
    m.on_boom.damping = 0.0;  // otherwise the modal dampers carry a force
    HammerOnBoom machine(m);
    std::array<double, 3> least{}, most{};
    for (int i = 1000; i <= 3000; ++i) {
      machine.advanceTo(1e-3 * i);
      const OnBoomTruth t = machine.truth();
      for (std::size_t k = 0; k < 3; ++k) {
        const double force = t.hold[static_cast<int>(k)] / boom.cylinders[k].arm(t.angles[static_cast<int>(k)]);
        idle[play > 0.0] += std::abs(force) < 30.0;
        least[k] = std::min(least[k], force), most[k] = std::max(most[k], force);
        both_ways[k] = least[k] < -500.0 && most[k] > 500.0;
      }
    }
  }
  ASSERT_TRUE(std::any_of(both_ways.begin(), both_ways.end(), [](bool b) { return b; })) << "no force turned around";
  EXPECT_LT(idle[0], 30);
  EXPECT_GT(idle[1], 5 * idle[0] + 50);
}

/// Returns the largest difference of the joints until 2.5 s [rad]; `largest` is the largest rigid displacement.
double bentAgainstRigid(double frequency, double& largest) {
  MachineSettings m = onBoom();
  HammerOnBoom rigid(m);
  m.on_boom.bending_frequency = frequency;
  m.on_boom.step = 1e-4;
  HammerOnBoom bends(m);
  double off = 0.0;
  largest = 0.0;
  for (int i = 1; i <= 2500; ++i) {
    rigid.advanceTo(1e-3 * i), bends.advanceTo(1e-3 * i);
    const Eigen::Vector3d a = rigid.truth().displacement, b = bends.truth().displacement;
    largest = std::max(largest, a.cwiseAbs().maxCoeff()), off = std::max(off, (a - b).cwiseAbs().maxCoeff());
  }
  return off;
}

/// The remaining difference is inversely proportional to the square of the frequency.
TEST(SimulatedBending, StiffOnesAreRigidOnes) {
  double largest = 0.0;
  const double off_100 = bentAgainstRigid(100.0, largest), off_200 = bentAgainstRigid(200.0, largest);
  EXPECT_GT(largest, 2e-3);
  EXPECT_LT(off_100, 0.1 * largest);
  EXPECT_NEAR(off_200, off_100 / 4.0, 0.1 * off_100);
}

/// Sums of squares from 5 to 15 s and from 15 to 25 s, one beat of two modes each, without damping by oil or links.
/// They are those of the joints' rates and of the hull's additional rate of rotation.
struct Swing {
  std::array<double, 2> joints{}, bent{};
};

Swing swingOf(double frequency) {
  MachineSettings m = onBoom();
  m.drive.stop_time = 1.5;
  m.on_boom.damping = m.on_boom.bending_damping = 0.0;
  m.on_boom.bending_frequency = frequency;
  HammerOnBoom machine(m);
  Swing swing;
  for (int i = 5000; i < 25000; ++i) {
    machine.advanceTo(1e-3 * i);
    const OnBoomTruth t = machine.truth();
    const auto k = static_cast<std::size_t>(i >= 15000);
    swing.joints[k] += t.rates.squaredNorm();
    swing.bent[k] += std::pow(t.imu_rate - t.rates.sum(), 2);
  }
  return swing;
}

/// A freely hanging crank dissipates equally in both cases. Bending links dissipate nothing more and rotate the hull.
TEST(SimulatedBending, TakesNoEnergyAndTurnsTheHull) {
  const Swing rigid = swingOf(0.0), bends = swingOf(15.0);
  EXPECT_GT(rigid.joints[0] / 10000.0, 1e-4);
  EXPECT_NEAR(bends.joints[1] / bends.joints[0], rigid.joints[1] / rigid.joints[0], 0.1);
  EXPECT_LT(rigid.bent[0], 1e-20 * rigid.joints[0]);
  EXPECT_GT(bends.bent[0], 1e-3 * bends.joints[0]);
}

/// The torque that holds a joint moves all bodies beyond it: Newton's law against the equations of the coordinates.
TEST(SimulatedBending, HoldsWhatIsBeyond) {
  for (const double frequency : {0.0, 15.0}) {
    MachineSettings m = onBoom();
    m.on_boom.bending_frequency = frequency;
    OilBoom boom = oilBoomEo2621();
    boom.cuts[0] = {0, {0.0, 0.0}, boom.links[0]};  // cut at the joint, whose pin transmits no moment
    HammerOnBoom machine(m, boom);
    for (int i = 1; i <= 2500; ++i) {
      machine.advanceTo(1e-3 * i);
      if (i % 7 != 0) continue;
      const OnBoomTruth t = machine.truth();
      ASSERT_NEAR(t.cut[0].torque_y, 0.0, 1e-3 * std::abs(t.hold[0]) + 10.0) << i;
    }
  }
}

TEST(CylinderFlaws, AHoseShowsThePressureLate) {
  MachineSettings m = swungBoom();
  m.on_boom.pressures.rate = 1000.0;
  const Session at_once = recordSession(m);
  m.on_boom.pressures.hose_lag = 5e-3;
  const Session late = recordSession(m);
  ASSERT_EQ(at_once.pressures.size(), late.pressures.size());
  double worst = 0.0, largest = 0.0, shown = at_once.pressures[0].bore[0];
  for (std::size_t i = 1; i < late.pressures.size(); ++i) {  // separate low-pass, one step per reading
    const double was = at_once.pressures[i - 1].bore[0], is = at_once.pressures[i].bore[0];
    shown += (0.5 * (was + is) - shown) * (1.0 - std::exp(-1e-3 / 5e-3));
    if (i < 100) continue;
    worst = std::max(worst, std::abs(late.pressures[i].bore[0] - shown));
    largest = std::max(largest, std::abs(is - late.pressures[i].bore[0]));
  }
  EXPECT_GT(largest, 2e4);
  EXPECT_LT(worst, 0.02 * largest);
}

/// Stamps keep their order. Their delays are distributed uniformly up to the maximum.
TEST(CylinderFlaws, ABusHoldsUpStamps) {
  MachineSettings m = swungBoom();
  const Session at_once = recordSession(m);
  m.on_boom.bus_delay = 3e-3;
  const Session waited = recordSession(m);
  const auto check = [](const auto& now, const auto& then) {
    ASSERT_EQ(now.size(), then.size());
    double sum = 0.0, most = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double late = 1e-9 * static_cast<double>(then[i].stamp - now[i].stamp);
      ASSERT_GE(late, 0.0);
      ASSERT_LE(late, 3e-3 + 1e-7);
      ASSERT_TRUE(i == 0 || then[i].stamp > then[i - 1].stamp);
      sum += late, most = std::max(most, late);
    }
    EXPECT_GT(most, 2.7e-3);
    EXPECT_GT(sum / static_cast<double>(now.size()), 1.3e-3);
    EXPECT_LT(sum / static_cast<double>(now.size()), 2.2e-3);
  };
  check(at_once.joints, waited.joints);
  check(at_once.imu, waited.imu);
  check(at_once.pressures, waited.pressures);
  EXPECT_EQ(at_once.crank.back().stamp, waited.crank.back().stamp);
}

}  // namespace
}  // namespace hammer_loads::simulation
