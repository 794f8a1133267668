// Tests that level pulse has the error stated in doc/model.md 3, within two standard deviations.
#include <gtest/gtest.h>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/stamp.h"
#include "pipeline/shipped_machine.h"
#include "support/held_hull.h"

namespace hammer_loads {
namespace {

struct Sample {
  StampNs stamp{};
  Eigen::Vector3d wrench, deviation;
};

/// Returns the published samples of the shipped machine between 3 s and 8 s.
std::vector<Sample> publishedAt(Level level) {
  Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  settings.pipeline.level = level;
  const simulation::Session session = simulation::recordSession(test::shippedMachine(settings, 8.5, 75));
  Pipeline pipeline(settings.mechanism, settings.pipeline, {});
  std::vector<Sample> samples;
  for (const simulation::CrankReading& reading : session.crank) {
    const SampleResult& result = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    const double time = 1e-9 * static_cast<double>(reading.stamp - session.crank.front().stamp);
    if (!result.isPublished() || time < 3.0 || time > 8.0) continue;
    samples.push_back({result.stamp, vectorOf(result.wrench), vectorOf(result.deviation.wrench())});
  }
  return samples;
}

TEST(PulseLevel, HasTheErrorThatTheModelStatesAndDeviationsThatContainIt) {
  const std::vector<Sample> pulse = publishedAt(Level::kPulse), rocker = publishedAt(Level::kRocker);
  ASSERT_EQ(pulse.size(), rocker.size());
  ASSERT_GT(pulse.size(), 4000U);
  Eigen::Array3d squares = Eigen::Array3d::Zero(), within = squares, peak = squares, stated = squares;
  for (std::size_t i = 0; i < pulse.size(); ++i) {
    ASSERT_EQ(pulse[i].stamp, rocker[i].stamp);
    const Eigen::Array3d error = pulse[i].wrench - rocker[i].wrench, deviation = pulse[i].deviation;
    squares += error.square(), stated += deviation.square();
    within += (error.abs() < 2.0 * deviation).cast<double>();
    peak = peak.max(rocker[i].wrench.array().abs());
  }
  const double count = static_cast<double>(pulse.size());
  const Eigen::Array3d rms = (squares / count).sqrt();
  const Eigen::Array3d of_peak{0.33, 0.24, 0.19};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(rms[k] / peak[k], of_peak[k], 0.015) << k;
    EXPECT_GT(within[k] / count, 0.95) << k;
    EXPECT_LT(std::sqrt(stated[k] / count), 1.3 * rms[k]) << "not merely large, " << k;
  }
}

}  // namespace
}  // namespace hammer_loads
