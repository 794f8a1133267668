// The track of a recording: when samples come out, where an interval ends, what later samples may do to a belief.
#include "hammer_loads/crank/crank_track.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "hammer_loads/crank/belief_smoothing.h"
#include "hammer_loads/crank/smoothed_crank.h"
#include "hammer_loads/util/square.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

namespace hammer_loads {
namespace {

struct Tracked {
  Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  CrankTrack track{mechanism, Level::kRocker, 0.6, test::filterSettings()};
};

/// What the filter believed after each sample.
using Beliefs = std::vector<CrankBelief>;

/// Seconds of a crank with jittering stamps at 500 Hz; from jump_at on the readings are a radian further.
Beliefs record(double seconds, double jump_at, CrankTrack& track) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  test::StrikingCrank crank(mechanism.linkage(), 0.737, 0.6);
  crank.blow = [](int number) { return test::StrikingCrank::Blow{number % 2 == 0 ? 0.8 : 1.1, true, 0.0}; };
  std::mt19937 random(4);
  std::normal_distribution<> jitter(0.0, 2e-4);
  Beliefs beliefs;
  double last = 0.0;
  for (int i = 1; i < static_cast<int>(500.0 * seconds); ++i) {
    crank.advanceTo(2e-3 * i);
    const double stamp = std::max(last + 1e-6, 2e-3 * i + jitter(random));
    const double reading = crank.angle() + (2e-3 * i > jump_at ? 1.0 : 0.0);
    const CrankSample sample{std::floor(reading / test::kEncoderCount) * test::kEncoderCount, std::nullopt};
    const Tracking tracking = i == 1 ? (track.start(sample), Tracking::kRestarted) : track.update(stamp - last, sample);
    if (tracking != Tracking::kOutlier) last = stamp;
    beliefs.push_back(track.filter().belief());
  }
  return beliefs;
}

std::vector<TrackedSample> samplesOf(CrankTrack& closed) {
  std::vector<TrackedSample> samples;
  while (closed.isReady()) samples.push_back(closed.take());
  return samples;
}

TEST(CrankTrack, GivesEverySampleOnceAndSomeSecondsLater) {
  Tracked machine;
  constexpr double kStep = 5e-3;
  std::size_t in = 0, out = 0, most = 0;
  double since_last = 0.0;  // accepted sample [s]
  machine.track.start({0.0, std::nullopt});
  for (in = 1; in < 20'000; ++in) {
    since_last += kStep;
    const CrankSample sample{25.0 * kStep * static_cast<double>(in), std::nullopt};
    if (machine.track.update(since_last, sample) != Tracking::kOutlier) since_last = 0.0;
    for (; machine.track.isReady(); ++out) machine.track.take();
    most = std::max(most, in - out);
  }
  EXPECT_LT(static_cast<double>(most) * kStep, 30.1) << "memory does not grow";
  EXPECT_LT(out, in);
  machine.track.close();
  for (; machine.track.isReady(); ++out) machine.track.take();
  EXPECT_EQ(out, in);
}

TEST(CrankTrack, LaterSamplesOnlyEverReduceTheDoubt) {
  Tracked machine;
  const Beliefs beliefs = record(4.0, 100.0, machine.track);
  machine.track.close();
  double filtered = 0.0, smoothed = 0.0;
  int index = 0;
  for (const CrankBelief& belief : beliefs) {
    ASSERT_TRUE(machine.track.isReady());
    const ShaftMatrix covariance = machine.track.take().belief.covariance;
    EXPECT_TRUE((covariance.diagonal().array() <= 1.000001 * belief.covariance.diagonal().array()).all());
    if (++index < 1000) continue;
    filtered += belief.covariance(CrankBelief::kTorque, CrankBelief::kTorque);
    smoothed += covariance(CrankBelief::kTorque, CrankBelief::kTorque);
  }
  EXPECT_LT(smoothed, 0.6 * filtered);
}

TEST(CrankTrack, KnowsAllOfATurnWhatItsBlowDid) {
  Tracked machine;
  record(4.0, 100.0, machine.track);
  machine.track.close();
  const std::vector<TrackedSample> samples = samplesOf(machine.track);
  int turns = 0;
  for (std::size_t i = 1000; i + 1 < samples.size(); ++i) {
    const CrankPosition &at = samples[i].belief.state.position, &next = samples[i + 1].belief.state.position;
    if (at.blowsPassed() == next.blowsPassed()) continue;
    ++turns;
    const double factor = samples[i + 1].belief.factor;  // just after a blow
    EXPECT_LT(std::min(std::abs(factor - 0.8), std::abs(factor - 1.1)), 0.02);
    EXPECT_GT(std::abs(factor - samples[i].belief.factor), 0.2) << "another blow, another factor";
  }
  EXPECT_GT(turns, 5);
}

/// At the end of a recording its belief is the live filter's. Of the sensor's errors that are not seen 1.8 times as
/// much counts, as noise covers less; of the torque's deviation a fifth, as its walk is that of the roughest supply.
TEST(CrankTrack, CountsMoreOfTheSensorAndLessOfTheSupplyThanLive) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const auto track = std::make_shared<CrankTrack>(mechanism, Level::kRocker, 0.6, test::filterSettings());
  record(4.0, 100.0, *track);
  track->close();
  const ShaftModel model(mechanism, Level::kRocker);
  SmoothedCrank smoothed(model, CrankFilter(model, 0.6, test::filterSettings()), track);
  while (track->isReady()) smoothed.update(0.0, {});
  const CrankFilter& live = track->filter();
  const auto accelerationVariance = [&](double part) {
    return smoothed.uncertainty(part).own(CrankUncertainty::kAcceleration, CrankUncertainty::kAcceleration);
  };
  const ShaftLoad load = ShaftModel(mechanism, Level::kRocker)(live.state().position.angle);
  const double by_torque = live.growth() * live.covariance()(CrankBelief::kTorque, CrankBelief::kTorque) /
                           square(live.driveInertia() + load.inertia);
  const double counted = 0.5 * (accelerationVariance(1.0) + accelerationVariance(-1.0)) - accelerationVariance(0.0);
  EXPECT_NEAR(std::sqrt(counted / by_torque) / 0.2, 1.0, 0.2);
  const auto bySensor = [](const CrankTracker& tracker) {
    return tracker.uncertainty(1.0).by_constant.topLeftCorner<1, ConstantErrors::kTable>().squaredNorm();
  };
  EXPECT_NEAR(bySensor(smoothed) / bySensor(live) / 1.8, 1.0, 0.2);
}

/// Where the smoothed sample after a blow is far from what the blow makes of the one before, there was another blow.
TEST(CrankTrack, ABlowThatIsFarOffEndsAnInterval) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const ShaftModel model(mechanism, Level::kRocker);
  const BlowPrior blow{0.8, 0.1};
  const CrankWalks walks{74.0, 0.3, 5e-4, {}};
  const FilterStep step{1e-3, {}, blow, walks, 600.0};
  CrankBelief before;
  before.state = {{0, {-0.01, Side::kBeforeBlow}}, 25.0, 100.0, 0.6};
  before.least_inertia = 1e-6, before.most_inertia = 1e6, before.factor = 0.8;
  before.covariance.diagonal() << 1e-8, 0.01, 100.0, 1e-4, 1e-4;
  CrankBelief after = before;
  ASSERT_EQ(after.predict(model, walks, blow, true, step.most_speed, step.length), 1);
  const double certainty = after.covariance.inverse()(CrankBelief::kFactor, CrankBelief::kFactor);
  for (const double part : {0.8, 1.25}) {
    CrankBelief next = after;
    next.factor += std::sqrt(part * 6.0 / certainty);
    EXPECT_EQ(smoothedBelief(model, step, before, after, next).has_value(), part < 1.0);
  }
}

TEST(CrankTrack, AnIntervalEndsWhereTheFilterRestarts) {
  Tracked machine;
  const Beliefs beliefs = record(4.0, 2.5, machine.track);
  machine.track.close();
  const std::vector<TrackedSample> samples = samplesOf(machine.track);
  ASSERT_EQ(samples.size(), beliefs.size());
  std::size_t restart = 2;
  while (restart < samples.size() && samples[restart].tracking != Tracking::kRestarted) ++restart;
  ASSERT_LT(restart, samples.size());
  std::size_t last = restart - 1;
  while (samples[last].tracking == Tracking::kOutlier) --last;
  EXPECT_EQ(samples[last].belief.state.speed, beliefs[last].state.speed);
  EXPECT_NE(samples[last - 100].belief.state.speed, beliefs[last - 100].state.speed);
}

}  // namespace
}  // namespace hammer_loads
