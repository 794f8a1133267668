/// Turn loads and cycles of a session against what the pipeline itself knows at every instant.
#include "hammer_loads/pipeline/life_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "hammer_loads/pipeline/step_wrenches.h"
#include "support/counting_new.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr double kPeak = 8.6e3;  // [N], about, of the session's turns

simulation::Session sessionAt(double rate,
                              const std::vector<simulation::CrankSensorSettings::Interval>& drop_outs = {}) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = test::kSessionEnd;
  machine.crank.rate = rate;
  machine.crank.drop_outs = drop_outs;
  return simulation::recordSession(machine);
}

/// Plays a session into pipeline and follower; each(result, follower) after every sample. The count of all of it.
template <typename Each>
life::LifePiece run(const Settings& settings, const simulation::Session& session, const Each& each) {
  test::Player player(settings, true, session);
  LifeFollower follower(player.pipeline, settings.life);
  player.playTo(1e9, [&](double, const SampleResult& result) {
    if (follower.due()) follower.take();
    follower.follow();
    each(result, follower);
  });
  follower.take();
  return follower.total().value();
}

const auto kNothing = [](const SampleResult&, const LifeFollower&) {};

TEST(TurnLoads, OfTheHullHaveThePulsesPeakAtAnyRate) {
  for (const double rate : {100.0, 1000.0}) {
    std::size_t turns = 0, withheld = 0;
    run(test::settingsWith("{}"), sessionAt(rate), [&](const SampleResult& result, const LifeFollower& follower) {
      withheld += result.beside_blow;
      for (std::size_t i = 0; i < result.turn_ends; ++i) {
        const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
        ASSERT_NE(turn, nullptr);
        ASSERT_EQ(turn->whole, result.ends[i].pulse.has_value());
        if (!turn->whole) continue;
        ++turns;
        const HalfSinePulse& pulse = *result.ends[i].pulse;
        // The pulse's amplitude is that of a parabola through points 1.25 ms apart, along the turn's own track.
        EXPECT_NEAR(turn->maximum[1], pulse.amplitude, 5e-4 * kPeak) << rate;
        // A mean is of what was published: at 100 Hz a sample withheld beside the blow is a twentieth of the turn.
        if (std::exchange(withheld, 0) > 0 && rate < 1000.0) continue;
        EXPECT_NEAR(turn->mean[1], pulse.turn_impulse_z / pulse.period, 0.01 * kPeak) << rate;
      }
    });
    EXPECT_GT(turns, 8U) << rate;
  }
}

/// As outputs of a high rate have it at the instant closest to the extreme; the last sample may be 10 ms before it.
TEST(TurnLoads, AnExtremeBetweenSamplesHasTheDeviationOfItsOwnPlace) {
  std::vector<WrenchOutput> outputs;
  int turns = 0;
  run(test::settingsWith("output_rate_Hz: 4000\n"), sessionAt(100.0),
      [&](const SampleResult& result, const LifeFollower& follower) {
        outputs.insert(outputs.end(), result.outputs.begin(), result.outputs.end());
        for (std::size_t i = 0; i < result.turn_ends; ++i) {
          const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
          if (turn == nullptr || !turn->whole) continue;
          const StampNs instant = turn->minimum_instant[0];
          const auto close = std::find_if(outputs.rbegin(), outputs.rend(),
                                          [&](const WrenchOutput& output) { return output.stamp <= instant; });
          ASSERT_NE(close, outputs.rend());
          if (seconds(instant - close->stamp) > 1e-3) continue;  // withheld beside the blow
          ++turns;
          const double there = close->deviation.wrench.force_x;
          EXPECT_NEAR(turn->of_minimum[0].deviation(), there, 0.2 * there) << turns;
        }
      });
  EXPECT_GT(turns, 8);
}

/// Instants within 8 ms of one [s].
std::vector<double> aroundBlow(double time) {
  std::vector<double> times;
  for (int i = -80; i <= 80; ++i) times.push_back(time + 1e-4 * i);
  return times;
}

/// At 100 Hz the next sample is 9 to 20 deg from the blow, where the force is a fifth less.
TEST(TurnLoads, ATurnWhoseSampleBesideTheBlowIsWithheldKeepsItsExtreme) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.crank.rate = 100.0;
  machine.crank.zero = 2.0 * kTwoPi / 360.0;
  machine.duration = 12.0;
  std::size_t judged = 0, withheld = 0;
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
          EXPECT_NEAR(turn->minimum[0], truth, 0.13 * std::abs(truth)) << end;
        }
        withheld += result.beside_blow;
      });
  EXPECT_GT(judged, 5U);
}

/// Where the rod's spring is followed, loads between samples are not those of a rigid path.
TEST(TurnLoads, OfARodThatGivesAreAsPublished) {
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
      counted[0] = std::min(counted[0], turn->minimum[0]), counted[1] = std::max(counted[1], turn->maximum[0]);
    }
  });
  EXPECT_GT(turns, 5U);
  EXPECT_LT(published[0], -8e3);
  EXPECT_GE(counted[0], 1.02 * published[0]);
  EXPECT_LE(counted[1], 1.02 * published[1]);
}

TEST(TurnLoads, OfJointsAreThoseOfTheSamples) {
  double greatest = -1e300;
  std::optional<StampNs> blow;
  std::size_t turns = 0;
  run(test::settingsWith("boom: rigid\n"), sessionAt(1000.0),
      [&](const SampleResult& result, const LifeFollower& follower) {
        const auto joint =
            std::find(follower.channels().begin(), follower.channels().end(), "joint_loads/arm_joint/total_torque_Nm");
        ASSERT_NE(joint, follower.channels().end());
        const auto channel = static_cast<std::size_t>(joint - follower.channels().begin());
        for (std::size_t i = 0; i < result.turn_ends; ++i) {
          const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
          // The samples of some 50 ms after a blow belong to the next turn: no greater load may come there in this
          // session.
          if (turn->whole && blow && *blow == turn->start) {
            ++turns;
            EXPECT_LE(turn->maximum[channel], greatest);
            EXPECT_GT(turn->maximum[channel], 0.9 * greatest);
            EXPECT_GE(turn->maximum_instant[channel], turn->start);
            EXPECT_LE(turn->maximum_instant[channel], turn->end);
          }
          blow = result.ends[i].stamp;
          greatest = -1e300;
        }
        if (result.refusal || result.boom == nullptr || result.boom->fault) return;
        greatest = std::max(greatest, result.boom->loads.total[static_cast<Eigen::Index>(channel - 3)]);
      });
  EXPECT_GT(turns, 5U);
}

TEST(StepWrenches, NoInstantOfAStepIsBeyondThem) {
  for (const double rate : {50.0, 1000.0}) {
    const simulation::Session session = sessionAt(rate);
    test::Player player(test::settingsWith("{}"), true, session);
    const Pipeline& pipeline = player.pipeline;
    double beyond = 0.0;
    std::size_t blows = 0;
    player.playTo(1e9, [&](double time_of_session, const SampleResult& result) {
      const CrankStep& step = pipeline.crank().step();
      if (time_of_session < test::kSessionWorks || result.refusal || !step.known()) return;
      const DriveReaction drive = driveReaction(pipeline.model(), step.driveInertia());
      const StepLoad load{pipeline.model(), drive, result.hull.motion};
      std::vector<double> times{0.0}, forces{load.at(step.at(0.0)).force_z};
      forEachStepWrench(
          load, step,
          [&](const StepPlace& place, const HullWrench& wrench) {
            EXPECT_GE(place.time, times.back());
            times.push_back(place.time);
            forces.push_back(wrench.force_z);
          },
          [&](double) { ++blows; });
      EXPECT_LE(times.back(), step.length());
      forces.push_back(result.wrench.force_z);
      const auto [least, greatest] = std::minmax_element(forces.begin(), forces.end());
      for (int i = 1; i < 50; ++i) {
        const double force = load.at(step.at(step.length() * i / 50.0)).force_z;
        beyond = std::max({beyond, force - *greatest, *least - force});
      }
    });
    EXPECT_GT(blows, 8U);
    EXPECT_LT(beyond, 3e-4 * kPeak) << rate;  // the cubic's extreme is some 1 % of 1.25 ms off
  }
}

/// Speeds through a low-pass, stamps that jitter but keep their order: a filter that trusts both is led astray, and
/// what lies between two of its samples may be of neither.
simulation::Session disturbed(double lag, double jitter, unsigned seed) {
  simulation::Session session = sessionAt(1000.0);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, jitter);
  std::vector<StampNs> stamps;
  double filtered = 0.0;
  StampNs last = session.crank.front().stamp;
  for (simulation::CrankReading& r : session.crank) {
    if (r.speed) {
      filtered += (1.0 - std::exp(-seconds(r.stamp - last) / lag)) * (*r.speed - filtered);
      r.speed = filtered;
    }
    last = r.stamp;
    stamps.push_back(r.stamp + static_cast<StampNs>(std::llround(1e9 * noise(random))));
  }
  std::sort(stamps.begin(), stamps.end());
  for (std::size_t i = 0; i < stamps.size(); ++i) session.crank[i].stamp = stamps[i];
  return session;
}

TEST(LoadCycles, NothingIsCountedFarBeyondWhatIsPublished) {
  for (const auto& [lag, jitter, seed] : {std::tuple{0.01, 1e-3, 1U}, {0.01, 1e-3, 2U}, {5e-3, 3e-4, 3U}}) {
    std::array<double, kHullChannels> least, greatest, values;
    least.fill(0.0);
    greatest.fill(0.0);
    std::size_t published = 0;
    const life::LifePiece piece = run(test::settingsWith("{}"), disturbed(lag, jitter, seed),
                                      [&](const SampleResult& result, const LifeFollower&) {
                                        if (result.refusal) return;
                                        for (const WrenchOutput& output : result.outputs) {
                                          ++published;
                                          wrenchValues(output.wrench, values.data());
                                          for (std::size_t i = 0; i < kHullChannels; ++i) {
                                            least[i] = std::min(least[i], values[i]);
                                            greatest[i] = std::max(greatest[i], values[i]);
                                          }
                                        }
                                      });
    EXPECT_GT(published, 2000U) << seed;
    for (std::size_t i = 0; i < kHullChannels; ++i) {
      EXPECT_LE(piece.counts[i].extremes.greatest, 1.02 * greatest[i]) << seed << ", channel " << i;
      EXPECT_GE(piece.counts[i].extremes.least, 1.02 * least[i]) << seed << ", channel " << i;
    }
  }
}

TEST(LoadCycles, OfSparseSamplesAreThoseOfDenseOnes) {
  const Settings settings = test::settingsWith("{}");
  const life::LifePiece sparse = run(settings, sessionAt(100.0), kNothing);
  const life::LifePiece dense = run(settings, sessionAt(1000.0), kNothing);
  for (const std::size_t channel : {0U, 1U}) {
    const auto largest = [&](const life::LifePiece& piece) {
      return life::rangesAndMeans(piece.counts[channel]).back().range;
    };
    EXPECT_NEAR(largest(sparse), largest(dense), 0.01 * largest(dense)) << channel;
  }
  EXPECT_EQ(sparse.turns, dense.turns);
  EXPECT_GT(dense.counts[1].tally.counted, 3000U);
  EXPECT_EQ(dense.counts[1].tally.skipped, 0U);
  EXPECT_EQ(dense.counts[1].tally.gaps, 0U);
  EXPECT_GT(dense.counts[1].tally.deviations, 3000U);
}

TEST(LoadCycles, AGapIsCountedAndItsTurnIsNotWhole) {
  std::vector<bool> whole;
  const life::LifePiece piece = run(test::settingsWith("{}"), sessionAt(1000.0, {{3.5, 3.9}}),
                                    [&](const SampleResult& result, const LifeFollower& follower) {
                                      for (std::size_t i = 0; i < result.turn_ends; ++i) {
                                        const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
                                        whole.push_back(turn != nullptr && turn->whole);
                                      }
                                    });
  EXPECT_EQ(piece.counts[1].tally.gaps, 1U);
  EXPECT_EQ(std::count(whole.begin() + 1, whole.end(), false), 1);
  EXPECT_EQ(piece.turns, whole.size());
}

TEST(LoadCycles, AllocatesNothingPerSample) {
  const Settings settings = test::settingsWith("boom: compliant\n");
  const simulation::Session session = sessionAt(1000.0);
  test::Player player(settings, true, session);
  LifeFollower follower(player.pipeline, settings.life);
  std::size_t allocated = 0, samples = 0;
  player.playTo(1e9, [&](double, const SampleResult& result) {
    ASSERT_FALSE(follower.due()) << "the session is shorter than the period";
    const std::size_t before = test::allocations;
    follower.follow();
    for (std::size_t i = 0; i < result.turn_ends; ++i) EXPECT_NE(follower.turnLoads(result.ends[i]), nullptr);
    allocated += test::allocations - before;
    ++samples;
  });
  EXPECT_EQ(allocated, 0U);
  EXPECT_GT(samples, 4000U);
}

}  // namespace
}  // namespace hammer_loads
