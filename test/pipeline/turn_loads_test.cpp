// Compares the loads of each revolution with those that the pipeline itself publishes.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "pipeline/life_session.h"

namespace hammer_loads {
namespace {

using test::kPeak;
using test::run;
using test::sessionAt;

TEST(TurnLoads, HaveThePulsesPeakAtAnyRateForTheHull) {
  for (const double rate : {100.0, 1000.0}) {
    std::size_t turns = 0, withheld = 0;
    run(test::settingsWith("{}"), sessionAt(rate), [&](const SampleResult& result, const LifeFollower& follower) {
      withheld += !result.refusal && !result.isPublished();
      for (std::size_t i = 0; i < result.turn_ends; ++i) {
        const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
        ASSERT_NE(turn, nullptr);
        ASSERT_EQ(turn->whole, result.ends[i].pulse.has_value());
        if (!turn->whole) continue;
        ++turns;
        const HalfSinePulse& pulse = *result.ends[i].pulse;
        // The pulse's amplitude is that of a parabola through points 1.25 ms apart on the revolution's own path.
        EXPECT_NEAR(turn->channels[1].maximum.value, pulse.amplitude, 5e-4 * kPeak) << rate;
        // The mean covers published samples. At 100 Hz one withheld beside the blow is a twentieth of the revolution.
        if (std::exchange(withheld, 0) > 0 && rate < 1000.0) continue;
        EXPECT_NEAR(turn->channels[1].mean, pulse.turn_impulse_z / pulse.period, 0.01 * kPeak) << rate;
      }
    });
    EXPECT_GT(turns, 8U) << rate;
  }
}

/// Revolution in which the zero becomes known: deviations change between its extreme and its end. A later extreme has
/// the deviation of the closest output of a high rate; the last sample may be 10 ms before it.
constexpr std::uint64_t kZeroKnown = 6;

TEST(TurnLoads, AnExtremeBetweenSamplesHasTheDeviationOfItsOwnPlace) {
  std::vector<WrenchOutput> outputs;
  int turns = 0;
  run(test::settingsWith("output_rate_Hz: 4000\n"), sessionAt(100.0),
      [&](const SampleResult& result, const LifeFollower& follower) {
        outputs.insert(outputs.end(), result.outputs.begin(), result.outputs.end());
        for (std::size_t i = 0; i < result.turn_ends; ++i) {
          const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
          if (turn == nullptr || !turn->whole || result.ends[i].turn <= kZeroKnown) continue;
          const StampNs instant = turn->channels[0].minimum.instant;
          const auto close = std::find_if(outputs.rbegin(), outputs.rend(),
                                          [&](const WrenchOutput& output) { return output.stamp <= instant; });
          ASSERT_NE(close, outputs.rend());
          if (seconds(instant - close->stamp) > 1e-3) continue;  // withheld beside the blow
          ++turns;
          const double there = close->deviation.wrench().force_x;
          EXPECT_NEAR(turn->channels[0].minimum.error.deviation(), there, 0.2 * there) << turns;
        }
      });
  EXPECT_GT(turns, 5);
}

/// Returns the instants within 8 ms of a blow [s].
std::vector<double> aroundBlow(double time) {
  std::vector<double> times;
  for (int i = -80; i <= 80; ++i) times.push_back(time + 1e-4 * i);
  return times;
}

/// At 100 Hz the next sample is 9 to 20 deg from the blow, where the force is a fifth less. With a zero 2 deg off, the
/// model's force is a tenth too large, increasingly so towards the blow.
TEST(TurnLoads, ATurnWhoseSampleBesideTheBlowIsWithheldKeepsItsExtreme) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.crank.rate = 100.0;
  machine.crank.zero = 2.0 * kTwoPi / 360.0;
  machine.duration = 12.0;
  std::size_t judged = 0, withheld = 0;
  double sum = 0.0, most = 0.0;  // sum and maximum of the ratio to the true extreme
  run(test::settingsWith("{}"), simulation::recordSession(machine),
      [&](const SampleResult& result, const LifeFollower& follower) {
        for (std::size_t i = 0; i < result.turn_ends; ++i) {
          const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
          const double end = 1e-9 * static_cast<double>(result.ends[i].stamp - machine.start_stamp);
          const bool is_judged = turn != nullptr && turn->whole && end > 6.0 && std::exchange(withheld, 0) > 0;
          if (!is_judged) continue;
          ++judged;
          double truth = 0.0;
          for (const auto& at : simulation::truthAt(machine, aroundBlow(end))) truth = std::min(truth, at.load.force_x);
          sum += turn->channels[0].minimum.value / truth;
          most = std::max(most, turn->channels[0].minimum.value / truth);
          EXPECT_NEAR(turn->channels[0].minimum.value, truth, 2.0 * turn->channels[0].minimum.error.deviation()) << end;
        }
        withheld += !result.refusal && !result.isPublished();
      });
  EXPECT_GT(judged, 5U);
  EXPECT_GT(sum, 0.9 * static_cast<double>(judged));
  EXPECT_LT(most, 1.02);
}

/// Level elastic follows the rod's spring: loads between samples differ from those of a rigid linkage.
TEST(TurnLoads, AreAsPublishedForAnElasticRod) {
  const Settings settings = test::settingsWith("level: elastic\n");
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.hammer = settings.mechanism.parameters();
  machine.level = Level::kLinkage;
  machine.rod = {4e8, 1.0, 1e-4};
  machine.seed = 2;
  machine.crank.counts = 4096;
  machine.duration = 8.0;
  machine.crank.drop_outs.clear();
  std::array<double, 2> published{}, counted{};  // least and greatest of force_x
  std::size_t turns = 0;
  run(settings, simulation::recordSession(machine), [&](const SampleResult& result, const LifeFollower& follower) {
    for (const WrenchOutput& output : result.outputs) {
      published[0] = std::min(published[0], output.wrench.force_x);
      published[1] = std::max(published[1], output.wrench.force_x);
    }
    for (std::size_t i = 0; i < result.turn_ends; ++i) {
      const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
      if (turn == nullptr || !turn->whole) continue;
      ++turns;
      counted[0] = std::min(counted[0], turn->channels[0].minimum.value),
      counted[1] = std::max(counted[1], turn->channels[0].maximum.value);
    }
  });
  EXPECT_GT(turns, 5U);
  EXPECT_LT(published[0], -8e3);
  EXPECT_GE(counted[0], 1.02 * published[0]);
  EXPECT_LE(counted[1], 1.02 * published[1]);
}

TEST(TurnLoads, AreThoseOfTheSamplesForJoints) {
  double greatest = -1e300;
  std::optional<StampNs> blow;
  std::size_t turns = 0;
  run(test::settingsWith("boom: rigid\n"), sessionAt(1000.0),
      [&](const SampleResult& result, const LifeFollower& follower) {
        const auto joint =
            std::find(follower.channels().begin(), follower.channels().end(), "joint_loads/arm_joint/total_torque");
        ASSERT_NE(joint, follower.channels().end());
        const auto channel = static_cast<std::size_t>(joint - follower.channels().begin());
        for (std::size_t i = 0; i < result.turn_ends; ++i) {
          const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
          // The samples of some 50 ms after a blow belong to the next revolution. No greater load may occur there in
          // this session.
          if (turn->whole && blow && *blow == turn->start) {
            ++turns;
            const life::LoadExtreme& maximum = turn->channels[channel].maximum;
            EXPECT_LE(maximum.value, greatest);
            EXPECT_GT(maximum.value, 0.9 * greatest);
            EXPECT_GE(maximum.instant, turn->start);
            EXPECT_LE(maximum.instant, turn->end);
          }
          blow = result.ends[i].stamp;
          greatest = -1e300;
        }
        if (result.refusal || result.boom == nullptr || result.boom->fault) return;
        greatest = std::max(greatest, result.boom->loads.total[static_cast<Eigen::Index>(channel - 3)]);
      });
  EXPECT_GT(turns, 5U);
}

}  // namespace
}  // namespace hammer_loads
