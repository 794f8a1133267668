// Readings that no hull gives: single ones are refused, sensors that go on giving them are not used.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "boom/booms.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/imu_trust.h"
#include "hammer_loads/pipeline/measured_torques.h"
#include "hammer_loads/pipeline/pressure_trust.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;
constexpr double kReadingStep = 1e-3;  // [s] between readings

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

using test::kMs;

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

TEST(CylinderPressures, LieOnTheLineThroughTheLastTwo) {
  CylinderPressures pressures(0.02);
  for (const StampNs t : {kMs, 3 * kMs}) {
    pressures.update(t, 0, Chamber::kBore, 1e6 * static_cast<double>(t / kMs));
    pressures.update(t, 0, Chamber::kRod, 2e6);
  }
  EXPECT_NEAR(pressures.at(0, 2 * kMs)->bore, 2e6, 1e-6);
  EXPECT_NEAR(pressures.at(0, 4 * kMs)->bore, 4e6, 1e-6);
  EXPECT_NEAR(pressures.at(0, 9 * kMs)->bore, 5e6, 1e-6) << "one interval beyond at most";
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

constexpr std::size_t kBoomCylinder = 0;

/// The shipped boom at rest and in mid air, its weight as steady torque. One cylinder has pressures.
class MeasuredBoom : public testing::Test {
 protected:
  MeasuredBoom() : boom_(test::shippedBoom()) {
    boom_.moveCompliant(motion_, {0.0, 0.0, -test::kGravity});
    boom_.vibration().rest();
    boom_.moveCompliant(motion_, {0.0, 0.0, -test::kGravity});
  }
  /// A reading of this torque beside the weight, and a sample of the crank at once.
  void read(double torque, double step = 1e-3) {
    stamp_ += static_cast<StampNs>(std::llround(1e9 * step));
    const Cylinder& cylinder = boom_.cylinders()[kBoomCylinder];
    const double push = -torque / boom_.cylinderPosition(kBoomCylinder).arm;
    pressures_.update(stamp_, kBoomCylinder, Chamber::kRod, 0.0);
    pressures_.update(stamp_, kBoomCylinder, Chamber::kBore, push / cylinder.boreArea());
    sample(0.0);
  }
  void sample(double later) {
    measured_.follow(boom_, motion_.position, none_, none_,
                     {stamp_ + static_cast<StampNs>(std::llround(1e9 * later)), 0.0}, pressures_);
  }
  const MeasuredTorques::Torque& torque() const { return *measured_.of(kBoomCylinder); }

  Boom boom_;
  JointVector none_ = JointVector::Zero(boom_.chain().joints());
  JointMotion motion_{test::workingPosition(), none_, none_};
  CylinderPressures pressures_{0.5};
  MeasuredTorques measured_;
  StampNs stamp_{test::kMs};
};

/// Of an even line, on whose second reading noise of 100 N m came by 1 ns later: no line goes through these two.
TEST_F(MeasuredBoom, ReadingsThatCameTogetherAreNoLine) {
  for (int i = 0; i < 100; ++i) read(10.0 * i);
  read(1100.0, 1e-9);
  sample(0.001);
  EXPECT_NEAR(torque().value, 1000.0, 2.0);
  EXPECT_LT(torque().deviation, 10.0);
  for (int i = 100; i < 150; ++i) read(10.0 * i);
  EXPECT_NEAR(torque().value, 1490.0, 2.0);
  EXPECT_LT(torque().deviation, 10.0);
}

}  // namespace
}  // namespace hammer_loads
