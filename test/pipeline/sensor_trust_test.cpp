// Readings that no hull gives: single ones are refused, sensors that go on giving them are not used.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/imu_trust.h"
#include "hammer_loads/pipeline/pressure_trust.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;
constexpr double kReadingStep = 1e-3;  // [s] between readings

TEST(HullImuJump, IsRefused) {
  HullImuSettings settings;
  settings.max_age = 0.02;
  const auto second = [&](double force, double rate) {
    HullImu imu(settings);
    imu.update(kMs, {{0.0, 0.0, 9.8}, {0.0, 0.0, 0.0}});
    return imu.update(2 * kMs, {{0.0, 0.0, 9.8 + force}, {0.0, rate, 0.0}});
  };
  EXPECT_FALSE(second(20.0, 0.3));
  EXPECT_EQ(second(1000.0, 0.0), ImuRefusal::kJump);
  EXPECT_EQ(second(0.0, 30.0), ImuRefusal::kJump);
}

/// An IMU on a hull at rest, where the weight is 10 m/s2. noise: readings alternate by it [m/s2].
class ImuOfAHull {
 public:
  void run(double time, double mean_error, double rate = 0.0, double noise = 1e-3) {
    for (int i = 0; i < std::lround(time / kReadingStep); ++i) {
      trust_.follow({0.0, 0.0, 10.0 - mean_error + (i % 2 == 0 ? noise : -noise)}, {0.0, rate, 0.0}, kReadingStep);
      trust_.judge({0.0, -10.0}, kReadingStep);
    }
  }
  bool isLost() const { return trust_.isLost(); }

 private:
  ImuTrust trust_;
};

TEST(ImuTrust, RejectsAWrongMeanUntilItIsRight) {
  ImuOfAHull imu;
  imu.run(10.0, 1.0, 0.3);
  EXPECT_FALSE(imu.isLost());
  imu.run(10.0, 9.0);
  EXPECT_TRUE(imu.isLost());
  imu.run(10.0, 0.0);
  EXPECT_FALSE(imu.isLost());
  imu.run(10.0, 0.0, 10.0);
  EXPECT_TRUE(imu.isLost());
}

TEST(ImuTrust, RejectsAFrozenUnit) {
  ImuOfAHull imu;
  imu.run(2.0, 0.0);
  imu.run(1.0, 0.0, 0.0, 0.0);
  EXPECT_TRUE(imu.isLost());
}

/// Pressures that disagree with a weight of 10 N on an arm of 1 m.
TEST(PressureTrust, RejectsAWrongMeanUntilItIsRight) {
  PressureTrust trust;
  const auto run = [&trust](double across, double turning) {
    for (int i = 0; i < 10000; ++i)
      trust.follow({{across, 0.0, 0.0}, {0.0, turning, 0.0}}, {{0.0, 0.0, -10.0}, {0.0, 0.0, 0.0}}, 1.0, kReadingStep);
    return trust.isLost();
  };
  EXPECT_FALSE(run(0.3, 1.0));
  EXPECT_TRUE(run(3.0, 0.0));
  EXPECT_FALSE(run(0.0, 0.0));
  EXPECT_TRUE(run(0.0, 9.0));
}

TEST(PressureTrust, TriesDelayedPressuresAgainLater) {
  PressureTrust trust;
  for (int i = 0; i < 200; ++i) trust.followDelay(0.02, 100.0, kReadingStep);
  EXPECT_TRUE(trust.isLate());
  trust.followDelay(0.0, 0.0, 1.0);
  EXPECT_TRUE(trust.isLate());
  for (int i = 0; i < 2000 && trust.isLate(); ++i) trust.followDelay(0.0, 0.0, 0.1);
  EXPECT_FALSE(trust.isLate());
}

}  // namespace
}  // namespace hammer_loads
