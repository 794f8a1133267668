#include "hammer_loads/pipeline/hull_imu.h"

#include <gtest/gtest.h>

#include <limits>

#include "hammer_loads/hammer/hull_model.h"
#include "support/constants.h"
#include "support/free_run.h"
#include "support/imu_on_hull.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::kMs;
const ImuReading kUpright{{0.0, 0.0, 9.80665}, {0.0, 0.0, 0.0}};

HullImuSettings atD() {
  HullImuSettings s;
  s.max_age = 0.02;
  return s;
}

/// Adds good readings until they give a motion, then the bad one, then good ones again.
void expectRefused(const ImuReading& bad, StampNs stamp, ImuRefusal why) {
  HullImu imu(atD());
  EXPECT_FALSE(imu.update(0, kUpright));
  EXPECT_FALSE(imu.at(0)) << "one reading tells no turning acceleration";
  EXPECT_FALSE(imu.update(kMs, kUpright));
  ASSERT_TRUE(imu.at(kMs));
  EXPECT_EQ(imu.update(stamp, bad), why);
  EXPECT_EQ(imu.newest().stamp, kMs);
  EXPECT_EQ(imu.at(kMs)->gravity.z, -9.80665);
  EXPECT_FALSE(imu.update(3 * kMs, kUpright));
  EXPECT_TRUE(imu.at(3 * kMs));
}

TEST(HullImu, RefusesWhatCannotBe) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  expectRefused({{nan, 0.0, 9.8}, {0.0, 0.0, 0.0}}, 2 * kMs, ImuRefusal::kNotFinite);
  expectRefused({{0.0, 0.0, 9.8}, {0.0, inf, 0.0}}, 2 * kMs, ImuRefusal::kNotFinite);
  expectRefused({{0.0, 0.0, 2001.0}, {0.0, 0.0, 0.0}}, 2 * kMs, ImuRefusal::kImplausible);
  expectRefused({{0.0, 0.0, 9.8}, {0.0, 101.0, 0.0}}, 2 * kMs, ImuRefusal::kImplausible);
  expectRefused(kUpright, kMs, ImuRefusal::kOutOfOrder);
  expectRefused(kUpright, 0, ImuRefusal::kOutOfOrder);
}

TEST(HullImu, AcceptsTimeRunningBackFromTheSecondReadingOn) {
  HullImu imu(atD());
  for (StampNs t : {5000 * kMs, 5001 * kMs}) imu.update(t, kUpright);
  EXPECT_EQ(imu.update(1000 * kMs, kUpright), ImuRefusal::kOutOfOrder);
  EXPECT_FALSE(imu.update(1001 * kMs, kUpright));
  EXPECT_FALSE(imu.at(1001 * kMs));
  EXPECT_FALSE(imu.update(1002 * kMs, kUpright));
  EXPECT_TRUE(imu.at(1002 * kMs));
}

/// Force error over the peak: largest and root mean square.
struct ForceError {
  double worst{}, sum{}, peak{};
  int count{};
  void add(const HullWrench& wrench, const HullWrench& right) {
    const double x = wrench.force_x - right.force_x, z = wrench.force_z - right.force_z;
    worst = std::max(worst, std::hypot(x, z));
    sum += x * x + z * z;
    ++count;
    peak = std::max(peak, right.force_z);
  }
  double largest() const { return worst / peak; }
  double rms() const { return std::sqrt(sum / count) / peak; }
};

struct SessionErrors {
  ForceError at_readings, between, fixed;
};

/// Plays three seconds of work of a 400 kg hull on its boom with readings at 1 kHz. The crank is known, so that all
/// error is the hull's. The two readings after a blow are left out, since no line follows the jump.
SessionErrors session(bool noise) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const test::FreeHull system(mechanism, Level::kRocker, test::onBoom());
  test::FreeRun run(system, test::hangingStill(test::onBoom(), 15.0), 160.0);
  const HullImuSettings mounting = test::imuMounting();
  HullImu imu(mounting);
  test::ImuNoise noisy(4);
  SessionErrors errors;
  int last_blows = 0, since_blow = 0;
  for (int i = 0; i < 6000; ++i, run.advance(5e-4)) {
    const test::FreeHull::Result right = run.result();
    const StampNs stamp = i * kMs / 2;
    const ImuReading reading = test::readingOf(right.hull, mounting);
    if (i % 2 == 0) imu.update(stamp, noise ? noisy(reading) : reading);
    since_blow = run.blows() == last_blows ? since_blow + 1 : 0;
    last_blows = run.blows();
    if (i < 10 || since_blow < 6) continue;
    const CrankMotion crank{run.state().crank, run.state().crank_speed, right.acceleration[3]};
    const HullWrench truth = hullWrench(mechanism, Level::kRocker, crank, right.hull);
    const double tilt = run.state().hull[2];
    const Gravity weight{9.80665 * std::sin(tilt), -9.80665 * std::cos(tilt)};
    (i % 2 == 0 ? errors.at_readings : errors.between)
        .add(hullWrench(mechanism, Level::kRocker, crank, *imu.at(stamp)), truth);
    errors.fixed.add(hullWrench(mechanism, Level::kRocker, crank, weight), truth);
  }
  EXPECT_GT(last_blows, 12);
  return errors;
}

/// Errors: half an interval's delay of the angular acceleration, linear interpolation between readings, and noise.
TEST(HullImu, GivesTheWrenchOfAMovingHullFromAnywhereOnIt) {
  const SessionErrors exact = session(false), noisy = session(true);
  EXPECT_NEAR(exact.fixed.peak, 8800.0, 50.0);
  EXPECT_GT(exact.fixed.largest(), 0.20);
  EXPECT_LT(exact.at_readings.largest(), 0.003);
  EXPECT_LT(exact.between.largest(), 0.006);
  EXPECT_LT(exact.between.rms(), 0.002);
  EXPECT_LT(noisy.at_readings.largest(), 0.022);
  EXPECT_LT(noisy.between.largest(), 0.022);
  EXPECT_LT(noisy.between.rms(), 0.007);
}

}  // namespace
}  // namespace hammer_loads
