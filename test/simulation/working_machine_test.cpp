#include "hammer_loads/simulation/working_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

/// Returns a session shorter than the standard one: 6 s, stop at 5 s.
MachineSettings shortRun() {
  MachineSettings s = workingMo100();
  s.duration = 6.0;
  s.drive.start_time = 0.9;
  s.drive.stop_time = 5.0;
  s.step = 1e-4;  // for a balance to ten digits
  return s;
}

void expectBalanced(const EnergyAccount& e) {
  EXPECT_NEAR(e.kinetic + e.blows + e.stops, e.motor - e.friction + e.weight, 1e-6);
  EXPECT_NEAR(e.stored, e.supply - e.motor - e.valves, 1e-6);
  EXPECT_GE(e.friction, 0.0);
  EXPECT_GE(e.valves, 0.0);
}

TEST(WorkingMachine, WorksLikeTheMachineInTheField) {
  WorkingMachine machine(workingMo100());
  machine.advanceTo(18.0);
  int count = 0;
  for (const BlowTruth& blow : machine.takeBlows()) {
    if (blow.time < 4.0) continue;
    ++count;
    EXPECT_TRUE(blow.whole_turn);
    EXPECT_NEAR(1.0 / blow.turn_period, 4.7, 0.1);
    EXPECT_NEAR(blow.strike.energy, 1010.0, 30.0);
    EXPECT_NEAR(blow.crank_speed, 13.7, 0.2);
    EXPECT_NEAR(blow.turn_peak_force_z, 8500.0, 200.0);
  }
  EXPECT_NEAR(count, 66, 1);
}

TEST(WorkingMachine, FallsBackStartsWorksAndStops) {
  MachineSettings s = workingMo100();
  s.step = 1e-4;  // for a balance to ten digits
  WorkingMachine machine(s);
  EXPECT_EQ(machine.truth().angle, 1.0);
  machine.advanceTo(0.3);
  EXPECT_LT(machine.truth().speed, -0.5);
  machine.advanceTo(1.2);
  EXPECT_EQ(machine.truth().angle, 0.0);
  EXPECT_EQ(machine.truth().speed, 0.0);
  EXPECT_EQ(machine.truth().acceleration, 0.0);
  EXPECT_TRUE(machine.takeBlows().empty());
  double fastest = 0.0;
  for (int i = 0; i < 600; ++i) {
    machine.advanceTo(5.0 + 1e-3 * i);
    fastest = std::max(fastest, machine.truth().speed);
  }
  EXPECT_NEAR(fastest, 53.0, 1.5);
  machine.advanceTo(20.0);
  EXPECT_LT(std::abs(machine.truth().speed), 0.05);
  expectBalanced(machine.energy());
}

/// Returns the largest difference of the force, relative to its peak.
double changeByAFifthOfTheStep(MachineSettings s) {
  WorkingMachine as_shipped(s);
  s.step *= 0.2;
  WorkingMachine fine(s);
  double worst = 0.0, peak = 0.0;
  for (double t = 0.001; t < 6.0; t += 0.001) {
    as_shipped.advanceTo(t), fine.advanceTo(t);
    const CrankTruth a = as_shipped.truth(), b = fine.truth();
    if (a.turn != b.turn) continue;  // the blow itself
    peak = std::max(peak, std::abs(b.load.force_z));
    worst = std::max(worst, std::hypot(a.load.force_x - b.load.force_x, a.load.force_z - b.load.force_z));
  }
  return worst / peak;
}

TEST(WorkingMachine, AFifthOfTheShippedStepGivesTheSame) {
  MachineSettings s = workingMo100();
  EXPECT_LT(changeByAFifthOfTheStep(s), 5e-6);
  s.drive.coupling_frequency = 60.0, s.drive.coupling_damping = 0.02, s.drive.motor_share = 0.3;
  EXPECT_LT(changeByAFifthOfTheStep(s), 5e-5);
}

/// The integral must give the impulse of the wrench = -(change of the rocker's momentum) + weight x time.
TEST(WorkingMachine, TurnImpulseIsTheMomentumDifference) {
  MachineSettings s = shortRun();
  for (JointMotion& joint : s.boom) joint = {0.0, 0.0, 1.0, 0.0};
  WorkingMachine machine(s);
  machine.advanceTo(5.0);
  const HammerParameters& p = s.hammer;
  double after_previous = 0.0;
  for (const BlowTruth& blow : machine.takeBlows()) {
    const double before = p.rocker_mass * p.rocker_com_distance * blow.strike.rocker_speed_before;
    if (blow.whole_turn) {
      const double weight = -p.rocker_mass * s.gravity * blow.turn_period;
      EXPECT_NEAR(blow.turn_impulse_z, weight - (before - after_previous), 1e-6);
      EXPECT_NEAR(blow.turn_impulse_x, 0.0, 1e-6);  // psi = 0 at both ends
    }
    after_previous = p.rocker_mass * p.rocker_com_distance * blow.strike.rocker_speed_after;
  }
}

TEST(WorkingMachine, AccelerationIsTheSpeedsDerivative) {
  WorkingMachine machine(shortRun());
  const double h = 1e-5;
  for (double t = 2.0; t < 3.0; t += 0.0137) {
    machine.advanceTo(t - h);
    const CrankTruth before = machine.truth();
    machine.advanceTo(t);
    const CrankTruth now = machine.truth();
    machine.advanceTo(t + h);
    const CrankTruth after = machine.truth();
    if (after.turn != before.turn) continue;  // the acceleration jumps at the blow
    EXPECT_NEAR(now.acceleration, (after.speed - before.speed) / (2.0 * h), 0.05) << t;
    EXPECT_NEAR(now.speed, (after.angle - before.angle) / (2.0 * h), 1e-4) << t;
  }
}

/// The rocker's centre of mass has a low point at the far end of its swing. Without drive and friction the crank
/// oscillates about it for ever.
TEST(WorkingMachine, SwingsByWeightWithoutLoss) {
  MachineSettings s = shortRun();
  s.drive.motor_displacement = s.drive.coulomb_friction = s.drive.viscous_friction = 0.0;
  for (JointMotion& joint : s.boom) joint = {0.0, 0.0, 1.0, 0.0};
  s.start_angle = 3.6;
  WorkingMachine machine(s);
  double least = 10.0, greatest = 0.0;
  int reversals = 0;
  bool forward = true;
  for (double t = 0.0; t < 20.0; t += 0.01) {
    machine.advanceTo(t);
    const CrankTruth truth = machine.truth();
    least = std::min(least, truth.angle);
    greatest = std::max(greatest, truth.angle);
    if (truth.speed != 0.0 && (truth.speed > 0.0) != forward) {
      forward = !forward;
      ++reversals;
    }
  }
  EXPECT_NEAR(least, 3.6, 1e-4);
  EXPECT_GT(greatest, 4.0);
  EXPECT_LT(greatest, 2.0 * kPi);
  EXPECT_GT(reversals, 5);
  EXPECT_NEAR(machine.energy().kinetic, machine.energy().weight, 1e-9);
}

}  // namespace
}  // namespace hammer_loads::simulation
