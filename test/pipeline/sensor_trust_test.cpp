// Readings that no hull can cause: single ones are refused, sensors that keep giving them are not used.
#include "hammer_loads/pipeline/sensor_trust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;
constexpr double kReadingStep = 1e-3;  // [s] between readings

/// IMU on a hull at rest, where the weight is 10 m/s2. noise: amplitude of alternating readings [m/s2].
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

TEST(CylinderPressures, NeedBothChambers) {
  CylinderPressures pressures(0.02);
  EXPECT_TRUE(pressures.update(kMs, 1, Chamber::kBore, 5e6));
  EXPECT_FALSE(pressures.at(1, kMs));
  EXPECT_TRUE(pressures.update(kMs, 1, Chamber::kRod, 1e6));
  ASSERT_TRUE(pressures.at(1, kMs));
  EXPECT_EQ(pressures.at(1, kMs)->bore, 5e6);
  EXPECT_FALSE(pressures.at(0, kMs)) << "another cylinder";
  EXPECT_FALSE(pressures.at(1, 30 * kMs)) << "too old";
}

TEST(CylinderPressures, RefuseWhatCannotBeAndGoOn) {
  CylinderPressures pressures(0.02);
  EXPECT_TRUE(pressures.update(10 * kMs, 0, Chamber::kBore, 5e6));
  EXPECT_FALSE(pressures.update(11 * kMs, 0, Chamber::kBore, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(pressures.update(11 * kMs, 0, Chamber::kBore, 1e9));
  EXPECT_FALSE(pressures.update(9 * kMs, 0, Chamber::kBore, 5e6)) << "late";
  EXPECT_EQ(pressures.refused(), 3U);
  EXPECT_TRUE(pressures.update(12 * kMs, 0, Chamber::kBore, 6e6));
  EXPECT_FALSE(pressures.update(1 * kMs, 0, Chamber::kBore, 5e6));
  EXPECT_TRUE(pressures.update(2 * kMs, 0, Chamber::kBore, 5e6)) << "time that runs back is believed the second time";
  EXPECT_EQ(pressures.accepted(), 3U);
}

}  // namespace
}  // namespace hammer_loads
