// Which joint angles show the boom's vibration, and how far they are believed: each within a factor of 1.25 of what is
// said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/pipeline/mode_observer.h"
#include "hammer_loads/util/square.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

/// The shipped boom as the operator holds it, at rest; angles of its second joint come at their own times.
class ObservedBoom : public testing::Test {
 protected:
  ObservedBoom() {
    position_[1] = -0.45, position_[2] = 1.0, position_[3] = -0.5;
    boom_.vibration().identify();
    for (int i = 0; i < 5000; ++i) held_.follow(motion(), 1e-3);
    boom_.moveCompliant(motion(), {0.0, 0.0, -9.80665});
    boom_.vibration().rest();
    boom_.moveCompliant(motion(), {0.0, 0.0, -9.80665});
  }
  JointMotion motion() const {
    const JointVector zero = JointVector::Zero(position_.size());
    return {position_, zero, zero};
  }
  /// The joint's angle beside that at which it is held, so long after the one before; age: the sample is later [ns].
  void read(double interval, double beside, StampNs age = 0) {
    stamp_ += static_cast<StampNs>(1e9 * interval);
    joints_.update(stamp_, {boom_.chain().jointNames()[1]}, {position_[1] + beside}, {});
    observer_.joints(boom_, held_, stamp_ + age, 1e-3, joints_);
  }
  const ModeIdentifier& found() const { return *boom_.vibration().identifier(); }
  /// Of the modes, without any force.
  JointVector foundAccelerations() const {
    const BoomModes& modes = boom_.vibration().modes();
    JointVector result(modes.count);
    for (int k = 0; k < modes.count; ++k)
      result[k] = acceleration({modes.omega[k], found().damping(k)}, found().motion(k), 0.0);
    return result;
  }

  Settings settings_ = accuracy::shippedBoom("{}");
  Boom boom_ = *settings_.boom;
  JointVector position_ = JointVector::Zero(boom_.chain().joints());
  HeldPose held_;
  JointBuffer joints_{boom_.chain(), settings_.pipeline};
  ModeObserver observer_{Eigen::Vector3d::Zero()};
  StampNs stamp_{1000000000};
};

/// Above 100 Hz.
TEST_F(ObservedBoom, AnglesThatComeRarelyShowNoVibration) {
  for (int i = 0; i < 20; ++i) read(0.0125, 0.0);
  EXPECT_EQ(found().channels(), 0);
  for (int i = 0; i < 2; ++i) read(0.008, 0.0);
  EXPECT_EQ(found().channels(), 1);
}

TEST_F(ObservedBoom, NorDoAnglesThatJump) {
  read(0.005, 0.0);
  read(0.005, 0.025);
  EXPECT_EQ(found().channels(), 0);
  read(0.005, 0.025 - 0.016);
  EXPECT_EQ(found().channels(), 1);
}

/// Samples are a millisecond apart here.
TEST_F(ObservedBoom, NorDoAnglesOfAnotherSample) {
  for (int i = 0; i < 2; ++i) read(0.005, 0.0, 900000);
  EXPECT_EQ(found().channels(), 0);
  read(0.005, 0.0, 600000);
  EXPECT_EQ(found().channels(), 1);
}

/// An angle's offset is some 0.01 rad, so that the first one says little.
TEST_F(ObservedBoom, OneAngleIsBelievedAsFarAsItsOffsetIsKnown) {
  const BoomModes& modes = boom_.vibration().modes();
  double variance = 0.0;  // before any reading, of the joint's vibration: ModeIdentifier's, 0.05 rad/s
  for (int k = 0; k < modes.count; ++k)
    variance += square(modes.shape(0, k) * 0.05 / modes.shape.col(k).cwiseAbs().maxCoeff() / modes.omega[k]);
  read(0.005, 0.0);
  read(0.005, 0.01);
  const double gain = found().displacement()[1] / 0.01, said = variance / (variance + square(0.01) + square(2e-4));
  EXPECT_GT(gain, 0.8 * said);
  EXPECT_LT(gain, 1.25 * said);
}

/// A gyro's as well, 0.02 rad/s.
TEST_F(ObservedBoom, OneRateIsBelievedAsFarAsItsOffsetIsKnown) {
  const BoomModes& modes = boom_.vibration().modes();
  const auto about_y = boom_.tipJacobian().row(4);
  double variance = 0.0;
  for (int k = 0; k < modes.count; ++k) {
    JointVector modal = JointVector::Zero(modes.count);
    modal[k] = 0.05 / modes.shape.col(k).cwiseAbs().maxCoeff();
    variance += square(about_y.dot(jointsOf(modes, modal)));
  }
  ImuReading reading{-boom_.gravityAtTip(), {0.0, 0.01, 0.0}};
  observer_.imu(boom_, held_, 0, 1e-3, {0, reading});
  const double gain = about_y.dot(found().velocity()) / 0.01,
               said = variance / (variance + square(0.02) + square(0.005));
  EXPECT_GT(1.0 - gain, 0.8 * (1.0 - said));
  EXPECT_LT(1.0 - gain, 1.25 * (1.0 - said));
}

/// Noise and offset are 0.3 m/s2 each; what the links in the hull make of it, 1 m/s2.
TEST_F(ObservedBoom, OneAccelerationIsBelievedAsFarAsOffsetAndLinksAreKnown) {
  const BoomModes& modes = boom_.vibration().modes();
  const Eigen::Vector3d here = Eigen::Vector3d::Zero(), g_T = boom_.gravityAtTip();
  Eigen::MatrixXd by_mode(2, modes.count);  // along x and z
  for (int k = 0; k < modes.count; ++k) {
    const JointVector joints = jointsOf(modes, JointVector::Unit(modes.count, k));
    for (int axis : {0, 1}) {
      const Eigen::Vector3d n_T = Eigen::Vector3d::Unit(2 * axis);
      by_mode(axis, k) =
          tipAccelerationReading(boom_.tipJacobian(), here, n_T, g_T, 0.0).acceleration.head(joints.size()).dot(joints);
    }
  }
  const Eigen::Matrix2d before = by_mode * found().accelerationCovariance() * by_mode.transpose();
  const double variance = square(0.3) + square(0.3) + square(1.0);
  const Eigen::Vector2d read(0.0, 1.0);
  observer_.imu(boom_, held_, 0, 1e-3, {0, {Eigen::Vector3d(0.0, 0.0, 1.0) - g_T, here}});
  const Eigen::Vector2d left = read - by_mode * foundAccelerations(),
                        said = variance * (before + variance * Eigen::Matrix2d::Identity()).inverse() * read;
  EXPECT_NEAR(left[1] / said[1], 1.0, 0.07);
}

/// Of the most that its cylinder can push, 0.02 of an offset and 0.004 of noise.
TEST_F(ObservedBoom, OneTorqueIsBelievedAsFarAsItsOffsetIsKnown) {
  const BoomModes& modes = boom_.vibration().modes();
  const Cylinder& cylinder = boom_.cylinders()[0];
  const double arm = boom_.cylinderPosition(0).arm;
  const JointVector by_mode = -modes.inertia.row(cylinder.joint());
  const double before = by_mode.dot(found().accelerationCovariance() * by_mode),
               variance = (square(0.02) + square(0.004)) * square(cylinder.greatestPush() * arm), read = 100.0;
  CylinderPressures pressures(0.1);
  pressures.update(stamp_, 0, Chamber::kRod, 0.0);
  pressures.update(stamp_, 0, Chamber::kBore,
                   -(boom_.steadyTorque(cylinder.joint()) + read) / arm / cylinder.boreArea());
  observer_.pressures(boom_, held_, stamp_, pressures);
  const double left = 1.0 - by_mode.dot(foundAccelerations()) / read, said = variance / (before + variance);
  EXPECT_GT(left, 0.8 * said);
  EXPECT_LT(left, 1.25 * said);
}

/// A zero that is off makes a right IMU look late; one that is late as well is late by the rest alone [s].
TEST(CrankLead, IsThatOfTheZeroAndNoMore) {
  simulation::MachineSettings machine = test::machineOnBoom(1.0, 50.0);
  machine.crank.zero = 1.0 * kDegree;
  machine.drive.start_time = 0.1;
  machine.duration = 6.0;
  const simulation::Session right = simulation::recordSession(machine);
  const Settings settings =
      test::withExactHammer(accuracy::shippedBoom("{boom: compliant, hull_motion: model, boom_stiffness: identified}"));
  for (const double late : {0.0, 1e-3}) {
    simulation::Session session = right;
    for (simulation::HullImuReading& r : session.imu) r.stamp += std::llround(1e9 * late);
    test::Player player(settings, true, session);
    player.pressures_speak = false;
    player.playTo(machine.duration, [](double, const SampleResult&) {});
    EXPECT_NEAR(player.pipeline.boom()->boom().vibration().identifier()->delay(Clock::kImu), late, 0.3e-3);
  }
}

}  // namespace
}  // namespace hammer_loads
