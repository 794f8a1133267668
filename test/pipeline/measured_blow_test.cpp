// Energies of simulated blows that take much of the crank's speed, at the dead centre or before it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "pipeline/shipped_machine.h"
#include "support/exact_hammer.h"
#include "support/held_hull.h"

namespace hammer_loads {
namespace {

/// Figures over all blows.
struct Blows {
  double worst{};                          ///< largest relative error of the energy [-]
  double deviation{}, largest_std{};       ///< relative standard deviation of the energy: mean and largest [-]
  std::size_t struck{};                    ///< true number of blows
  std::size_t count{}, known{}, within{};  ///< known: energy stated; within: its error within two standard deviations
  double impulse_bias{};                   ///< mean relative error of the tool's impulse [-]
  std::size_t impulse_within{};            ///< blows with the impulse within two standard deviations
};

Blows follow(const std::function<void(simulation::MachineSettings&)>& flaw, double rate, std::uint64_t seed) {
  const Settings shipped = test::withExactHammer(test::heldHull(*load(configDirectory(), {}).value));
  simulation::MachineSettings machine = test::shippedMachine(shipped, 13.0, seed);
  machine.crank.rate = rate;
  flaw(machine);
  const simulation::Session session = simulation::recordSession(machine);
  Blows blows;
  for (const simulation::BlowTruth& t : session.blows) blows.struck += t.time >= 3.0;
  for (const accuracy::BlowAt& b :
       accuracy::runSession(session, machine.start_stamp, shipped.mechanism, shipped.pipeline).blows)
    for (const simulation::BlowTruth& t : session.blows) {
      if (std::abs(t.time - b.time) > 0.01 || b.time < 3.0) continue;
      ++blows.count;
      blows.impulse_bias += b.tool_impulse / t.strike.tool_impulse - 1.0;
      blows.impulse_within += std::abs(b.tool_impulse - t.strike.tool_impulse) < 2.0 * b.tool_impulse_std;
      if (std::isnan(b.energy)) continue;
      ++blows.known;
      const double error = std::abs(b.energy / t.strike.energy - 1.0);
      const double deviation = b.energy_std / t.strike.energy;
      blows.worst = std::max(blows.worst, error);
      blows.deviation += deviation;
      blows.largest_std = std::max(blows.largest_std, deviation);
      blows.within += error < 2.0 * deviation;
    }
  blows.deviation /= static_cast<double>(blows.known);
  blows.impulse_bias /= static_cast<double>(blows.count);
  return blows;
}

/// Returns the parts of the blows within two standard deviations: [0] energy, [1] restitution.
std::array<double, 2> coveredBeforeCalibrate(double rate, double zero) {
  std::array<double, 2> covered{};
  double count = 0.0;
  for (std::uint64_t seed = 600; seed < 603; ++seed) {
    const Settings shipped = test::withExactHammer(test::heldHull(*load(configDirectory(), {}).value));
    simulation::MachineSettings machine = test::shippedMachine(shipped, 20.0, seed);
    accuracy::makeTypical(machine);
    machine.crank.rate = rate;
    machine.crank.zero = zero;
    const simulation::Session session = simulation::recordSession(machine);
    Pipeline pipeline(shipped.mechanism, shipped.pipeline, {});
    for (const simulation::CrankReading& reading : session.crank) {
      const SampleResult& result = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
      for (std::size_t k = 0; k < result.turn_ends; ++k) {
        const double time = 1e-9 * static_cast<double>(result.ends[k].stamp - machine.start_stamp);
        const auto truth = std::find_if(session.blows.begin(), session.blows.end(),
                                        [&](const auto& t) { return std::abs(t.time - time) < 0.01; });
        if (truth == session.blows.end() || time < 3.0 || time > 17.0) continue;
        const RockerBlow& blow = result.ends[k].blow;
        const double restitution = -truth->strike.rocker_speed_after / truth->strike.rocker_speed_before;
        covered[0] += std::abs(blow.energy - truth->strike.energy) < 2.0 * blow.energy_std;
        covered[1] += std::abs(blow.restitution - restitution) < 2.0 * blow.restitution_std;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 150.0);
  return {covered[0] / count, covered[1] / count};
}

/// The zero is 0.5 deg off, the encoder has 1024 counts, stamps of a PC and no speeds, and the blows differ. The
/// deviations contain the uncertainty of the zero, whether or not its error shows.
TEST(MeasuredBlow, DeviationsHoldBeforeCalibrateToo) {
  for (const double zero : {0.5, -0.5}) {
    const auto often = coveredBeforeCalibrate(1000.0, zero * kPi / 180.0);
    EXPECT_GT(often[0], 0.92) << zero;
    EXPECT_GT(often[1], 0.9) << zero;
    const auto seldom = coveredBeforeCalibrate(200.0, zero * kPi / 180.0);
    EXPECT_GT(seldom[0], 0.7) << zero;
    EXPECT_GT(seldom[1], 0.88) << zero;
  }
}

/// Draws the restitution. The machine works to the end, since a crank that comes to rest is a separate question.
void drawRestitution(simulation::MachineSettings& machine) {
  machine.blow.restitution_drawn = true;
  machine.blow.restitution_high = 0.3;
  machine.drive.stop_time = machine.duration;
}

/// A passage that is taken back, as an encoder's edge may show, must not count as a second blow. No restitution slows
/// the crank so much: no energy is stated.
TEST(MeasuredBlow, HasNoRestitutionIfItTakesHalfTheSpeed) {
  for (const std::uint64_t seed : {503u, 505u}) {
    const Blows blows = follow([](auto& machine) { machine.blow.crank_loss = 0.45; }, 1000.0, seed);
    EXPECT_GT(blows.count, 30u);
    EXPECT_EQ(blows.count, blows.struck) << seed;
    EXPECT_EQ(blows.known, 0u) << seed;
    EXPECT_LT(blows.worst, 0.05) << seed;
  }
}

/// The crank reaches the dead centre with its speed after the blow, and drive and links together push the tool. No
/// restitution from 0 to 1 describes this: the energy is not stated, or is within its deviation.
TEST(MeasuredBlow, GivesNoWrongEnergyForAToolMetEarly) {
  std::size_t wrong = 0;
  struct Sensor {
    double rate;
    bool speed;
  };
  for (const double degrees : {0.3, 1.0, 2.0}) {
    for (const Sensor& sensor : {Sensor{1000.0, true}, {100.0, true}, {1000.0, false}}) {
      for (const std::uint64_t seed : {501u, 503u}) {
        const Blows blows = follow(
            [&](auto& machine) {
              machine.blow.tool_early = degrees * kDegree;
              machine.crank.speed = sensor.speed;
            },
            sensor.rate, seed);
        SCOPED_TRACE(testing::Message() << degrees << " deg, " << sensor.rate << " Hz, " << sensor.speed << ' '
                                        << seed);
        EXPECT_GT(blows.count, 25u);
        if (degrees < 1.0) {
          EXPECT_LT(blows.worst, 0.2);
        }
        wrong += blows.known - blows.within;
        EXPECT_GE(blows.impulse_within, 0.88 * static_cast<double>(blows.count));
        EXPECT_LT(std::abs(blows.impulse_bias), sensor.speed ? 0.1 : 0.3);
      }
    }
  }
  EXPECT_LE(wrong, 1u);  // of some 600
}

/// Jittering stamps leave uncertain which sample shows the blow, but not the blow once it is measured. A count that
/// shows the dead centre late or early makes a blow seem to act too soon or too late.
TEST(MeasuredBlow, FollowsADrawnRestitution) {
  struct Sensor {
    double jitter, zero;
    bool speed;
    std::uint64_t seed;
  };
  for (const Sensor& c : {Sensor{0.0, 0.0, true, 301u},
                          {0.0, 0.0, false, 906u},
                          {2e-4, 0.0, true, 906u},
                          {2e-4, 0.0, false, 301u},
                          {0.0, -0.5 * kDegree, true, 302u},
                          {0.0, 0.5 * kDegree, true, 304u},
                          {2e-4, -0.5 * kDegree, true, 304u},
                          {2e-4, 0.5 * kDegree, true, 302u}}) {
    const Blows blows = follow(
        [&](auto& machine) {
          drawRestitution(machine);
          machine.crank.stamp_noise = c.jitter, machine.crank.zero = c.zero, machine.crank.speed = c.speed;
        },
        1000.0, c.seed);
    SCOPED_TRACE(testing::Message() << "jitter " << c.jitter << " s, zero " << c.zero << ", speeds " << c.speed);
    EXPECT_GT(blows.count, 30u);
    EXPECT_LT(blows.worst, c.zero == 0.0 ? 0.025 : 0.06);
    if (c.zero != 0.0) continue;
    EXPECT_LT(blows.deviation, 0.02);
    EXPECT_LT(blows.largest_std, 0.08);
    EXPECT_GT(blows.within, 0.9 * static_cast<double>(blows.count));
  }
}

/// The crank stands still before it works. Without speeds all samples of a burst are alike.
TEST(MeasuredBlow, IsAccurateForSamplesInBurstsWithoutSpeeds) {
  for (const double rate : {100.0, 200.0, 1000.0}) {
    for (const std::uint64_t seed : {612u, 806u}) {
      const Blows blows =
          follow([](auto& machine) { machine.crank.burst = 10, machine.crank.speed = false; }, rate, seed);
      EXPECT_GT(blows.count, 30u);
      EXPECT_LT(blows.worst, 0.03) << rate << ' ' << seed;
    }
  }
}

}  // namespace
}  // namespace hammer_loads
