#include "hammer_loads/simulation/elastic_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

MachineSettings elastic(double stiffness, double damping_ratio, double play = 0.0) {
  MachineSettings s = workingMo100();
  s.rod = {stiffness, damping_ratio, play};
  return s;
}

/// With masses of crank and rod that no symmetry hides.
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

/// The force on the hull has taken from the links what their momentum changed by, and from the tool what it gave.
TEST(ElasticMachine, ImpulseOfTheHullIsTheChangeOfMomentum) {
  for (const NamedMachine& named : elasticMachines()) {
    MachineSettings settings = named.settings;
    settings.gravity = 0.0;
    ElasticMachine machine(settings);
    // Momentum by differences of the centre of mass, from angles alone: rocker only.
    if (settings.level != Level::kRocker) continue;
    const HammerParameters& p = settings.hammer;
    const auto momentum = [&](const CrankTruth& t) {
      return std::array<double, 2>{p.rocker_mass * p.rocker_com_distance * std::sin(t.rocker_angle) * t.rocker_speed,
                                   p.rocker_mass * p.rocker_com_distance * std::cos(t.rocker_angle) * t.rocker_speed};
    };
    machine.advanceTo(2.4);
    const auto before = momentum(machine.truth());
    std::array<double, 2> hull{}, tool{};
    constexpr int kSteps = 80000;
    constexpr double kStep = 5e-6;  // Simpson's, across some blows
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

}  // namespace
}  // namespace hammer_loads::simulation
