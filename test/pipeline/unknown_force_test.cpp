// Standard deviations after a blow of machines that no level models: friction and clearance of the pins, weak damping,
// a rod that bends. The machines are test::WornMachine, which shares no equation with the package.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/damage.h"
#include "pipeline/shipped_machine.h"
#include "support/worn_run.h"

namespace hammer_loads {
namespace {

using test::Covered;
using test::coveredOf;
using test::wornMo100;

/// Returns the results without friction and clearance, for six seconds.
const Covered& coveredAsNew() {
  static const Covered covered = [] {
    test::WornMachineSettings machine = wornMo100(test::shippedDrawing());
    machine.duration = 6.0;
    return coveredOf(test::shippedDrawing(), machine);
  }();
  return covered;
}

TEST(WornMachine, IsCoveredWithFrictionAndClearance) {
  test::WornMachineSettings machine = wornMo100(test::shippedDrawing());
  machine.friction = 0.04, machine.clearance = 1e-4;
  const Covered covered = coveredOf(test::shippedDrawing(), machine);
  EXPECT_GT(covered.least(), 0.85);
  EXPECT_GT(covered.blows, 4);
  EXPECT_GE(covered.energies + 1, covered.blows);
}

/// Friction brakes crank and rocker and resembles a zero of the encoder that is -6 deg off. The spring and the friction
/// are identified: the loads after a blow are as accurate as without friction.
TEST(WornMachine, IsFollowedWithFriction) {
  test::WornMachineSettings machine = wornMo100(test::shippedDrawing());
  machine.duration = 5.0;
  machine.friction = 0.05;
  const Covered& smooth = coveredAsNew();
  const Covered covered = coveredOf(test::shippedDrawing(), machine);
  EXPECT_GT(covered.least(), 0.9);
  EXPECT_GT(covered.followed, 9 * covered.after_blow / 10);
  EXPECT_LT(covered.error[0] / covered.count[0], 2.0 * smooth.error[0] / smooth.count[0]);
}

/// A rocker that hardly rebounds is pulled along by the rod, which nearly stops the crank.
TEST(WornMachine, IsFollowedAfterABlowThatNearlyStopsTheCrank) {
  test::WornMachineSettings machine = wornMo100(test::shippedDrawing());
  machine.restitution = 0.06, machine.restitution_spread = 0.0, machine.duration = 5.0;
  const Covered covered = coveredOf(test::shippedDrawing(), machine);
  EXPECT_GT(covered.followed, 9 * covered.after_blow / 10);
  EXPECT_LT(std::sqrt(covered.error[0] / covered.count[0]), 1000.0);
}

/// Contacts in pins with clearance load the hull for a small share of the time, but their crests determine an
/// equivalent range. The readings show a clearance: the range of a machine without one is not stated as uncertain.
TEST(WornMachine, HasAnUncertainRangeOnlyWhereItsPinsShowClearance) {
  const auto rangeOf = [](const Covered& covered) {
    return life::equivalentLoad(life::rangesAndMeans(*covered.counts), 5.0, 1.0, life::rangeDeviation(*covered.counts));
  };
  const auto trueRange = [](const Covered& covered) {
    return life::equivalentLoad(life::rangesAndMeans(covered.true_loads), 5.0, 1.0, {}).value;
  };
  const Covered& tight = coveredAsNew();
  EXPECT_NEAR(rangeOf(tight).value, trueRange(tight), 2.0 * rangeOf(tight).deviation);
  EXPECT_LT(rangeOf(tight).deviation, 0.2 * trueRange(tight));
  test::WornMachineSettings machine = wornMo100(test::shippedDrawing());
  machine.duration = 6.0, machine.clearance = 1e-4;
  const Covered worn = coveredOf(test::shippedDrawing(), machine);
  EXPECT_LT(rangeOf(worn).value, 0.85 * trueRange(worn));
  EXPECT_NEAR(rangeOf(worn).value, trueRange(worn), 2.0 * rangeOf(worn).deviation);
}

}  // namespace
}  // namespace hammer_loads
