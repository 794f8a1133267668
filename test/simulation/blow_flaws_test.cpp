// Flaws of the simulated machine's blow and drive: specified effect of each, balance of energy and momentum.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"
#include "simulation/flawed_run.h"

namespace hammer_loads::simulation {
namespace {

using test::flawedRun;

MachineSettings heavyLinks() {
  MachineSettings s = flawedRun();
  s.level = Level::kLinkage;
  s.hammer.rod_mass = 9.0;
  s.hammer.rod_com_along = 0.07;
  s.hammer.rod_com_across = -0.004;
  s.hammer.rod_inertia_about_com = 0.03;
  s.hammer.crank_mass = 6.0;
  s.hammer.crank_com_along = 0.02;
  return s;
}

/// Expects a balance within the integration's error, 1e-10 of the transferred energy.
void expectAllAccountedFor(const EnergyAccount& e) {
  EXPECT_NEAR(e.kinetic + e.blows + e.losses + e.stops, e.motor - e.friction + e.weight, 1e-6 + 1e-10 * e.motor);
  EXPECT_NEAR(e.stored, e.supply - e.motor - e.valves, 1e-6 + 1e-10 * e.motor);
}

TEST(Blows, EveryWayOfMeetingTheToolBalancesItsEnergy) {
  for (const bool early : {false, true}) {
    for (MachineSettings s : {flawedRun(), heavyLinks()}) {
      s.blow = {true, 0.0, 0.3, 0.1, 0.0, 50.0, 0.1};
      s.drive.coupling_frequency = 80.0;
      if (early) s.blow.tool_early = 0.3 * kTwoPi / 360.0;
      s.step = 5e-5;  // for a balance to ten digits
      WorkingMachine machine(s);
      machine.advanceTo(s.duration);
      expectAllAccountedFor(machine.energy());
      double energy = 0.0;
      const std::vector<BlowTruth> blows = machine.takeBlows();
      for (const BlowTruth& blow : blows) energy += blow.strike.energy;
      EXPECT_NEAR(machine.energy().blows, energy, 1e-6) << early;
      EXPECT_GT(blows.size(), 15U) << early;
    }
  }
}

/// Models rocker and rod as particles on massless bars. Momenta are sums over the particles, without a mass matrix.
TEST(Blows, ToolsImpulseAndMomentumDecideTheSpeeds) {
  const MachineSettings s = heavyLinks();
  const HammerParameters& p = s.hammer;
  const MovingLinks links(*Mechanism::make(p).value, s.level);
  const double w = 14.0, restitution = 0.22, drive = 0.6;
  const Strike strike = links.strike(w, restitution, drive);
  EXPECT_NEAR(strike.rocker_speed_after, -restitution * strike.rocker_speed_before, 1e-12);

  // Transverse velocities of the pins. The rod is two masses with its inertia, including that of its offset.
  struct Speeds {
    double b, c;
  };
  const double l1 = p.lengths.crank, l2 = Mechanism::make(p).value->linkage().lengths().rod, l3 = p.lengths.rocker;
  const double about = p.rod_inertia_about_com + p.rod_mass * p.rod_com_across * p.rod_com_across;
  const double arm = std::sqrt(about / p.rod_mass);  // two half masses at com +- arm
  const double crank = drive + p.crank_inertia_about_com + p.crank_mass * p.crank_com_along * p.crank_com_along;
  // Returns the angular impulses on crank (about A) and rocker (about D) that give these speeds from rest.
  const auto moments = [&](Speeds v) {
    double at_b = 0.0, at_c = 0.0;
    for (const double place : {p.rod_com_along - arm, p.rod_com_along + arm}) {
      const double impulse = 0.5 * p.rod_mass * (v.b + (v.c - v.b) * place / l2);
      at_c += impulse * place / l2;
      at_b += impulse * (1.0 - place / l2);
    }
    return Eigen::Vector2d{crank * v.b / l1 + l1 * at_b, p.rocker_inertia_about_pivot * v.c / l3 + l3 * at_c};
  };
  // Returns the speeds of the pins from moments, by inverting the moments of unit speeds.
  Eigen::Matrix2d columns;
  columns << moments({1.0, 0.0}), moments({0.0, 1.0});
  const auto speeds = [&](const Eigen::Vector2d& m) { return Eigen::Vector2d(columns.inverse() * m); };

  const Eigen::Vector2d before = moments({l1 * w, l3 * strike.rocker_speed_before});
  const Eigen::Vector2d free = speeds(before + Eigen::Vector2d{0.0, strike.tool_impulse * p.striking_distance});
  EXPECT_NEAR(free[1] / l3, strike.rocker_speed_after, 1e-9 * w);
  // The loop closes by moments (-u, 1) of the pins' forces, which do no work on a motion with rocker = u crank.
  const double u = links.rockerAngle({0.0, false}).first;
  const Eigen::Vector2d pull = speeds({-u, 1.0});
  const double size = (u * free[0] / l1 - free[1] / l3) / (pull[1] / l3 - u * pull[0] / l1);
  EXPECT_NEAR((free[0] + size * pull[0]) / l1, strike.crank_speed_after, 1e-9 * w);

  const auto energy = [&](const Eigen::Vector2d& m) {
    const Eigen::Vector2d v = speeds(m);
    return 0.5 * (m[0] * v[0] / l1 + m[1] * v[1] / l3);
  };
  EXPECT_NEAR(strike.energy, energy(before) - energy(moments({free[0], free[1]})), 1e-9 * strike.energy);
  EXPECT_GT(strike.linkage_loss, 0.0);
}

TEST(Blows, RestitutionIsDrawnBetweenItsBounds) {
  MachineSettings s = flawedRun();
  s.duration = 20.0;
  s.blow.restitution_drawn = true;
  s.blow.restitution_high = 0.3;
  const std::vector<BlowTruth> blows = recordSession(s).blows;
  double sum = 0.0, least = 1.0, most = 0.0;
  for (const BlowTruth& b : blows) {
    const double r = -b.strike.rocker_speed_after / b.strike.rocker_speed_before;
    sum += r;
    least = std::min(least, r);
    most = std::max(most, r);
  }
  const double n = static_cast<double>(blows.size());
  EXPECT_NEAR(sum / n, 0.15, 4.0 * 0.3 / std::sqrt(12.0 * n));
  EXPECT_GE(least, 0.0);
  EXPECT_LE(most, 0.3);
  EXPECT_GT(most - least, 0.25);
}

TEST(Blows, SpeedAfterIsWhatTheCrankGoesOnWith) {
  for (int way = 0; way < 2; ++way) {
    MachineSettings s = flawedRun();
    if (way == 0) s.blow.crank_loss = 0.35;
    if (way == 1) s.blow = {true, 0.0, 0.3, 0.0, 0.0, 50.0, 0.0};
    const std::vector<BlowTruth> blows = recordSession(s).blows;
    std::vector<double> times;
    for (const BlowTruth& b : blows) times.insert(times.end(), {b.time - 1e-6, b.time + 1e-6});
    const std::vector<CrankTruth> beside = truthAt(s, times);
    for (std::size_t i = 0; i < blows.size(); ++i) {
      EXPECT_NEAR(beside[2 * i].speed, blows[i].crank_speed, 1e-3);
      EXPECT_NEAR(beside[2 * i + 1].speed, blows[i].strike.crank_speed_after, 1e-3);
      if (way == 0) {
        EXPECT_NEAR(beside[2 * i + 1].speed / beside[2 * i].speed, 0.65, 1e-4);
      }
    }
  }
}

TEST(Blows, EarlyToolSlowsTheCrankBeforeTheDeadCentre) {
  MachineSettings s = flawedRun();
  s.blow.tool_early = 0.3 * kTwoPi / 360.0;
  const std::vector<BlowTruth> blows = recordSession(s).blows;
  std::vector<double> times;
  for (const BlowTruth& b : blows) times.insert(times.end(), {b.time - 1e-6, b.time + 1e-6});
  const std::vector<CrankTruth> beside = truthAt(s, times);
  for (std::size_t i = 3; i < blows.size(); ++i) {
    EXPECT_NEAR(beside[2 * i].angle, kTwoPi - s.blow.tool_early, 1e-4);
    // Momentum about the crank's shaft of drive, rocker and tool, u = -3.88 (model.md 1).
    const double rocker = 0.737 * 3.88 * 3.88, tool = 50.0 * std::pow(3.88 * s.hammer.striking_distance, 2);
    EXPECT_NEAR(beside[2 * i + 1].speed / beside[2 * i].speed, (0.6 + rocker) / (0.6 + rocker + tool), 2e-3);
  }
}

/// Without tool and friction both branches are equivalent, and energy is conserved over all revolutions.
TEST(Blows, BlankTurnGoesThroughTheMirroredBranchSmoothly) {
  MachineSettings s = flawedRun();
  s.blow.blank_share = 1.0;
  s.drive.coulomb_friction = s.drive.viscous_friction = s.drive.leakage = 0.0;
  s.gravity = 0.0;
  WorkingMachine machine(s);
  double psi_before = 0.0;
  const MovingLinks links(*Mechanism::make(s.hammer).value, s.level);
  int mirrored = 0, upright = 0;
  for (double t = 0.0; t < 4.0; t += 2e-4) {
    machine.advanceTo(t);
    const CrankTruth truth = machine.truth();
    const bool before = truth.angle > 0.5 * kTwoPi;
    const Jet psi = links.rockerAngle({before ? truth.angle - kTwoPi : truth.angle, before, truth.mirrored});
    if (t > 0.0) {
      ASSERT_NEAR(psi.value, psi_before, 2e-4 * std::abs(psi.first * truth.speed) + 2e-3) << t;
    }
    psi_before = psi.value;
    (truth.mirrored ? mirrored : upright) += 1;
    ASSERT_TRUE(truth.mirrored ? psi.value <= 1e-9 : psi.value >= -1e-9);
  }
  EXPECT_GT(mirrored, 4000);
  EXPECT_GT(upright, 4000);
  EXPECT_TRUE(machine.takeBlows().empty());
  expectAllAccountedFor(machine.energy());
}

TEST(Coupling, MotorSwingsAgainstTheCrankAtItsFrequency) {
  MachineSettings s = flawedRun();
  s.drive.coupling_frequency = 60.0;
  s.drive.coupling_damping = 0.0;
  s.drive.motor_share = 0.3;
  // A rocker of negligible inertia leaves two discs on a spring.
  s.hammer.rocker_mass = 1e-3;
  s.hammer.rocker_inertia_about_pivot = 1.2e-5;
  s.gravity = 0.0;
  s.drive.coulomb_friction = s.drive.ripple = 0.0;
  s.drive.start_time = 0.1;
  s.drive.start_ramp = 1e-3;
  WorkingMachine machine(s);
  std::vector<double> rising;
  double last = 0.0, last_slope = 0.0;
  for (int i = 2000; i < 6000; ++i) {  // minima of the twisting speed; its slow part cancels in the slope
    machine.advanceTo(1e-4 * i);
    const double twisting = machine.truth().motor_speed - machine.truth().speed, slope = twisting - last;
    if (i > 2001 && last_slope < 0.0 && slope >= 0.0) rising.push_back(1e-4 * (i - slope / (slope - last_slope)));
    last = twisting;
    last_slope = slope;
  }
  ASSERT_GT(rising.size(), 10U);
  EXPECT_NEAR(static_cast<double>(rising.size() - 1) / (rising.back() - rising.front()), 60.0, 0.5);
}

}  // namespace
}  // namespace hammer_loads::simulation
