// The crank filter in a hull that moves, against hull and mechanism simulated as one free system.
#include <gtest/gtest.h>

#include <random>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/hammer/hull_wrench.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/free_run.h"
#include "support/imu_on_hull.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::kMs;

enum class Known { kPitch, kImu, kAll };

struct Errors {
  double acceleration{};  ///< of the crank: root mean square over the peak
  double force{};         ///< on the hull along the tool: likewise
  double inertia{};       ///< of the drive, relative, at the end
};

/// Six seconds at 1 kHz with encoder counts and noisy speeds; errors from the third second on.
Errors followed(const test::HullBody& body, Known known) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const test::FreeHull system(mechanism, Level::kRocker, body);
  test::FreeRun run(system, test::hangingStill(body, 15.0), 160.0);
  CrankFilter filter(ShaftModel(mechanism, Level::kRocker), 0.6, test::filterSettings(test::kEncoderCount));
  const HullImuSettings mounting = test::imuMounting();
  HullImu imu(mounting);
  test::ImuNoise noisy(4);
  std::mt19937 random(3);
  std::normal_distribution<> noise(0.0, 0.15);
  double squares = 0.0, peak = 0.0, force_squares = 0.0, force_peak = 0.0;
  int count = 0;
  for (int i = 0; i < 6000; ++i, run.advance(1e-3)) {
    const test::FreeHull::Result truth = run.result();
    const test::FreeState state = run.state();
    imu.update(i * kMs, noisy(test::readingOf(truth.hull, mounting)));
    const double tilt = state.hull[2];
    const Gravity weight{body.gravity * std::sin(tilt), -body.gravity * std::cos(tilt)};
    HullMotion hull = weight;
    if (known == Known::kAll) hull = truth.hull;
    if (known == Known::kImu) hull = imu.at(i * kMs).value_or(weight);
    filter.setHullMotion(hull);
    const double phi = state.crank.offset + (state.crank.side == Side::kBeforeBlow ? kTwoPi : 0.0);
    const CrankSample sample{std::floor(phi / test::kEncoderCount) * test::kEncoderCount,
                             state.crank_speed + noise(random)};
    if (i == 0) {
      filter.start(sample);
    } else {
      filter.update(1e-3, sample);
    }
    if (i < 2000) continue;
    squares += std::pow(filter.estimate().acceleration - truth.acceleration[3], 2);
    peak = std::max(peak, std::abs(truth.acceleration[3]));
    const CrankEstimate e = filter.estimate();
    const HullWrench wrench = hullWrench(mechanism, Level::kRocker, {e.position.angle, e.speed, e.acceleration}, hull);
    force_squares += std::pow(wrench.force_z - truth.force_z, 2);
    force_peak = std::max(force_peak, std::abs(truth.force_z));
    ++count;
  }
  return {std::sqrt(squares / count) / peak, std::sqrt(force_squares / count) / force_peak,
          filter.state().drive_inertia / mechanism.parameters().drive_inertia - 1.0};
}

TEST(FilterInMovingHull, FollowsTheCrankAsInAFixedHull) {
  const Errors fixed = followed(test::unmoved(), Known::kPitch);
  const Errors known = followed(test::onBoom(), Known::kAll);
  EXPECT_LT(fixed.acceleration, 0.0025);
  EXPECT_LT(known.acceleration, fixed.acceleration);
  EXPECT_LT(fixed.force, 0.0015);
  EXPECT_LT(known.force, 0.0015);
  EXPECT_NEAR(fixed.inertia, 0.0, 0.002);
  EXPECT_NEAR(known.inertia, 0.0, 0.002);
}

/// The noise of the turning's acceleration, 0.003 rad/s sqrt(2)/1 ms, is the crank's too; it is relative to the hull.
TEST(FilterInMovingHull, IsNearlyAsGoodWithAnImuAndFarBetterThanWithout) {
  const Errors imu = followed(test::onBoom(), Known::kImu), pitch = followed(test::onBoom(), Known::kPitch);
  EXPECT_LT(imu.acceleration, 0.0035);
  EXPECT_LT(imu.force, 0.006);
  EXPECT_NEAR(imu.inertia, 0.0, 0.004);
  EXPECT_GT(pitch.acceleration, 0.005);
  EXPECT_GT(pitch.force, 0.03);
  EXPECT_GT(std::abs(pitch.inertia), 0.02);
}

}  // namespace
}  // namespace hammer_loads
