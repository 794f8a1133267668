// A passage of the blow at the very end of a step, or a crank that falls back on the tool, is no force on the hull.
#include <gtest/gtest.h>

#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::kSessionEnd;
using test::Player;
using test::settingsWith;

/// The whole session: before it works the crank falls back on the tool.
class EncoderZero : public testing::TestWithParam<double> {};

TEST_P(EncoderZero, NoMeanAndNoVibrationIsAKick) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = kSessionEnd;
  machine.crank.zero = GetParam();
  const simulation::Session session = simulation::recordSession(machine);
  double peak = 0.0, stops = 0.0;
  for (const simulation::CrankTruth& t : session.truth) {
    peak = std::max(peak, t.load.force_z);
    if (t.time < 2.0) stops += t.speed == 0.0;
  }
  EXPECT_GT(stops, 100.0) << "it rests on the tool before it works";
  Player right(settingsWith("boom: compliant\n")), off(settingsWith("output: mean\nboom: compliant\n"), true, session);
  double torque = 0.0, off_torque = 0.0, force = 0.0;
  const auto largest = [](const SampleResult& result) { return result.boom->loads.vibration.cwiseAbs().maxCoeff(); };
  right.playTo(kSessionEnd, [&](double, const SampleResult& result) {
    if (!result.refusal && !result.boom->fault) torque = std::max(torque, largest(result));
  });
  off.playTo(kSessionEnd, [&](double, const SampleResult& result) {
    if (result.refusal) return;
    for (const WrenchOutput& output : result.outputs)
      force = std::max(force, std::hypot(output.wrench.force_x, output.wrench.force_z));
    if (!result.boom->fault) off_torque = std::max(off_torque, largest(result));
  });
  EXPECT_LT(force, 1.6 * peak);
  EXPECT_LT(off_torque, 1.5 * torque);
}

INSTANTIATE_TEST_SUITE_P(Off, EncoderZero, testing::Values(-0.01, -0.001, 0.0, 0.001, 0.01));

}  // namespace
}  // namespace hammer_loads
