#include "hammer_loads/simulation/elastic_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

MachineSettings elastic(double stiffness, double damping_ratio, double play = 0.0) {
  MachineSettings s = workingMo100();
  s.rod = {stiffness, damping_ratio, play};
  return s;
}

/// Adds asymmetric masses of crank and rod.
MachineSettings heavy(MachineSettings s) {
  s.level = Level::kLinkage;
  HammerParameters& p = s.hammer;
  p.crank_mass = 6.0, p.crank_com_along = 0.015, p.crank_com_across = 0.004, p.crank_inertia_about_com = 0.01;
  p.rod_mass = 4.5, p.rod_com_along = 0.070, p.rod_com_across = -0.004, p.rod_inertia_about_com = 0.012;
  return s;
}

double imbalance(const ElasticEnergy& e) {
  return e.kinetic + e.elastic + e.tool + e.rod + e.blow - (e.motor - e.friction + e.weight);
}

struct NamedMachine {
  const char* name;
  MachineSettings settings;
};

std::vector<NamedMachine> elasticMachines() {
  MachineSettings blank = elastic(1e9, 0.2), retainer = blank, together = heavy(elastic(8e8, 0.3, 1e-4));
  blank.blow.blank_share = 0.3;
  retainer.strike.retainer_stiffness = 3e8, retainer.strike.no_tool_from = 2.5, retainer.strike.no_tool_to = 3.5;
  together.strike.tool_spread = 1e-3;
  return {{"average", elastic(1e9, 0.2)},
          {"dead", elastic(1e9, 3.0)},
          {"play", elastic(1e9, 0.2, 5e-4)},
          {"blank", blank},
          {"retainer", retainer},
          {"together", together},
          {"soft", elastic(4e8, 0.6)},
          {"heavy", heavy(elastic(1e9, 0.3))}};
}

TEST(ElasticMachine, WorkOfTheDriveIsKineticElasticAndLost) {
  for (const NamedMachine& named : elasticMachines()) {
    ElasticMachine machine(named.settings);
    double elastic_most = 0.0, tool_most = 0.0;
    for (int i = 1; i <= 800; ++i) {
      machine.advanceTo(5e-3 * i);
      const ElasticEnergy e = machine.energy();
      elastic_most = std::max(elastic_most, e.elastic), tool_most = std::max(tool_most, e.tool);
      ASSERT_NEAR(imbalance(e), 0.0, 1e-5 * std::max(e.motor, 100.0)) << named.name << ' ' << machine.time();
      ASSERT_GE(e.rod, 0.0) << named.name;
    }
    const ElasticEnergy e = machine.energy();
    EXPECT_GT(e.motor, 5e3) << named.name;
    EXPECT_GT(e.blow, 2e3) << named.name;
    EXPECT_GT(e.rod, 5.0) << named.name;
    EXPECT_GT(elastic_most, 1e-3) << named.name;
    EXPECT_GT(tool_most, 1e-3) << named.name;
  }
}

/// The impulse on the hull equals the links' loss of momentum plus the impulse of the tool.
TEST(ElasticMachine, ImpulseOfTheHullIsTheChangeOfMomentum) {
  for (const NamedMachine& named : elasticMachines()) {
    MachineSettings settings = named.settings;
    settings.gravity = 0.0;
    ElasticMachine machine(settings);
    // Momentum from angle and speed of the rocker, whose mass alone is considered.
    if (settings.level != Level::kRocker || settings.rod.damping_ratio > 0.2) continue;
    const HammerParameters& p = settings.hammer;
    const auto momentum = [&](const CrankTruth& t) {
      return std::array<double, 2>{p.rocker_mass * p.rocker_com_distance * std::sin(t.rocker_angle) * t.rocker_speed,
                                   p.rocker_mass * p.rocker_com_distance * std::cos(t.rocker_angle) * t.rocker_speed};
    };
    machine.advanceTo(2.4);
    const auto before = momentum(machine.truth());
    std::array<double, 2> hull{}, tool{};
    constexpr int kSteps = 80000;
    constexpr double kStep = 5e-6;  // step of Simpson's rule, across some blows [s]
    CrankTruth last = machine.truth();
    for (int i = 0; i < kSteps; ++i) {
      machine.advanceTo(2.4 + (i + 0.5) * kStep);
      const CrankTruth middle = machine.truth();
      machine.advanceTo(2.4 + (i + 1) * kStep);
      const CrankTruth end = machine.truth();
      const auto simpson = [&](auto value) { return kStep / 6.0 * (value(last) + 4.0 * value(middle) + value(end)); };
      hull[0] += simpson([](const CrankTruth& t) { return t.load.force_x; });
      hull[1] += simpson([](const CrankTruth& t) { return t.load.force_z; });
      tool[1] += simpson([](const CrankTruth& t) { return t.tool_force; });
      last = end;
    }
    const auto after = momentum(machine.truth());
    EXPECT_NEAR(hull[0], before[0] - after[0], 0.2) << named.name;
    EXPECT_NEAR(hull[1], before[1] - after[1] + tool[1], 0.2) << named.name;
    EXPECT_GT(tool[1], 50.0) << named.name;
  }
}

/// The difference from the independent rigid machine is inversely proportional to the stiffness, except near the dead
/// centre. There a rigid rod in line with the crank would carry any force.
TEST(ElasticMachine, BecomesTheRigidOneWithAStiffRod) {
  for (const bool masses : {false, true}) {
    double last = 0.0;
    for (const double stiffness : {1e9, 4e9}) {
      MachineSettings settings = masses ? heavy(elastic(stiffness, 0.3)) : elastic(stiffness, 0.3);
      settings.start_angle = 2.5, settings.drive.start_time = 0.01, settings.drive.start_ramp = 0.02;
      MachineSettings rigid_settings = settings;
      rigid_settings.rod = {};
      WorkingMachine rigid(rigid_settings);
      ElasticMachine machine(settings);
      double worst = 0.0, peak = 0.0;
      for (double time = 0.02; rigid.truth().angle < 5.9; time += 5e-4) {
        rigid.advanceTo(time);
        machine.advanceTo(time);
        const CrankTruth a = rigid.truth(), b = machine.truth();
        worst = std::max(worst, std::abs(a.load.force_z - b.load.force_z));
        peak = std::max(peak, std::abs(a.load.force_z));
      }
      EXPECT_LT(worst, 1e-3 * peak);
      if (last > 0.0) {
        EXPECT_NEAR(worst / last, 0.25, 0.05);
      }
      last = worst;
    }
  }
}

/// A large inertia holds the crank. The rocker, which its weight excites, vibrates on the rod at the frequency of
/// k (dl/dpsi)^2 over I.
TEST(ElasticMachine, VibratesAtTheFrequencyOfMassAndStiffness) {
  MachineSettings settings = elastic(1e9, 0.01);
  settings.drive.inertia = 1e6, settings.start_angle = 0.5, settings.drive.start_time = 1.0;
  const ElasticLinks links(settings.hammer, Level::kRocker);
  const double psi = links.rockerAngle(0.5);
  const double slope = (links.rod({0.5, psi + 1e-5}).stretch - links.rod({0.5, psi - 1e-5}).stretch) / 2e-5;
  ElasticMachine machine(settings);
  std::vector<double> rises;
  double before = 0.0;
  for (int i = 1; i <= 20000; ++i) {
    machine.advanceTo(2e-6 * i);
    const double speed = machine.truth().rocker_speed;
    if (before < 0.0 && speed >= 0.0) rises.push_back(2e-6 * i);
    before = speed;
  }
  ASSERT_GT(rises.size(), 3U);
  const double period = (rises.back() - rises.front()) / static_cast<double>(rises.size() - 1);
  EXPECT_NEAR(1.0 / period, std::abs(slope) * std::sqrt(1e9 / settings.hammer.rocker_inertia_about_pivot) / (2.0 * kPi),
              0.01 / period);
}

/// Without a tool the hull's retainer takes the blow, and no impulse is attributed to the tool.
TEST(ElasticMachine, RetainerTakesTheBlowWithoutATool) {
  MachineSettings settings = elastic(1e9, 0.4);
  settings.strike.retainer_stiffness = 3e8, settings.strike.no_tool_from = 3.0, settings.strike.no_tool_to = 4.0;
  ElasticMachine machine(settings);
  machine.advanceTo(5.0);
  int on_tool = 0, on_retainer = 0;
  for (const BlowTruth& blow : machine.takeBlows()) {
    if (blow.time < 2.6) continue;
    const bool retained = blow.retainer_impulse > 50.0;
    EXPECT_EQ(retained, blow.time > 3.1 && blow.time < 4.1) << blow.time;
    if (retained) {
      EXPECT_EQ(blow.strike.tool_impulse, 0.0);
    } else {
      EXPECT_GT(blow.strike.tool_impulse, 150.0);
    }
    (retained ? on_retainer : on_tool) += 1;
  }
  EXPECT_GT(on_tool, 4);
  EXPECT_GT(on_retainer, 2);
}

/// The supply opens after 1.4 s. Until then the crank swings and the rocker falls onto the tool some ten times, at
/// 0.3 m/s at most.
TEST(ElasticMachine, StrikesNothingBeforeItIsDriven) {
  MachineSettings settings = elastic(7e8, 0.4, 1e-4);
  ElasticMachine machine(settings);
  double touches = 0.0;
  for (int i = 0; i < 14000; ++i) {
    machine.advanceTo(1e-4 * i);
    touches += machine.truth().touches();
  }
  EXPECT_GT(touches, 10.0);
  EXPECT_TRUE(machine.takeBlows().empty());
}

/// The hull's motion is slow compared with a blow, so that the contact is the same on a boom and with a fixed hull.
TEST(ElasticMachine, StrikesOnItsBoomAsHeld) {
  MachineSettings settings = elastic(7e8, 0.4, 1e-4);
  ElasticMachine held(settings);
  settings.on_boom.on = true;
  HammerOnBoom on_boom(settings);
  held.advanceTo(3.5);
  on_boom.advanceTo(3.5);
  const std::vector<BlowTruth> a = held.takeBlows(), b = on_boom.takeBlows();
  ASSERT_GT(b.size(), 5U);
  const Strike x = a.back().strike, y = b.back().strike;
  EXPECT_NEAR(y.rocker_speed_after / y.rocker_speed_before, x.rocker_speed_after / x.rocker_speed_before, 0.02);
  EXPECT_NEAR(y.tool_impulse / y.rocker_speed_before, x.tool_impulse / x.rocker_speed_before, 0.05);
  EXPECT_NEAR(b.back().contact, a.back().contact, 1e-5);
  EXPECT_TRUE(b.back().whole_turn);
}

/// Second contacts are chaotic, so that the motion must not depend on the requested times.
TEST(ElasticMachine, MovesTheSameWhoeverLooks) {
  ElasticMachine seldom(elastic(1e9, 0.2)), often(elastic(1e9, 0.2));
  seldom.advanceTo(6.0);
  for (int i = 1; i <= 7000; ++i) often.advanceTo(6.0 * i / 7000.0);
  EXPECT_EQ(seldom.truth().speed, often.truth().speed);
  EXPECT_EQ(seldom.truth().load.force_z, often.truth().load.force_z);
}

}  // namespace
}  // namespace hammer_loads::simulation
