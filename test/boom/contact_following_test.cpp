// Rock force estimated from pressures and an IMU, compared with the boom of vibrating_machine.h. The damping of that
// boom, 7 % at the first mode and 30 % at the third, differs from the file's 5 %.
#include <gtest/gtest.h>

#include "boom/vibrating_machine.h"
#include "hammer_loads/bench/estimate_errors.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

using test::kGravity, test::kMillisecond;

constexpr double kFoot = -0.1975, kLeast = 500.0;  ///< [m], [N]

/// Returns the rock's force [N]: the operator's hold-down force of 2 kN, and a pulse of 12 ms every 0.2128 s.
double rockForce(double time) {
  const double phase = (std::fmod(time, 0.2128) - 0.1) / 0.012;
  return 2000.0 + (phase > 0.0 && phase < 1.0 ? 2.5e4 * std::sin(test::kHalfTurn * phase) : 0.0);
}

class OnRock {
 public:
  explicit OnRock(bool imu) : machine_(test::shippedBoomParameters(), 1e9, 3), imu_(imu) {
    const JointVector zero = JointVector::Zero(4);
    boom.moveCompliant({test::workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
    by_newton_ = boom.hammerTorque({{0.0, 0.0, 1.0}, {0.0, -kFoot, 0.0}});
    boom.vibration().followContact(by_newton_, kLeast);
  }

  /// Runs with `size` times the rock's force. Errors are counted in the last second.
  void run(double seconds, double size) {
    const int steps = static_cast<int>(seconds / kMillisecond);
    for (int i = 0; i < steps; ++i) {
      time_ += kMillisecond;
      const Wrench w = hammer_.at(time_);
      const double rock = size * rockForce(time_);
      const Eigen::Vector3d load = machine_.load(w) + rock * by_newton_.tail<3>();
      machine_.step(load_, load);
      load_ = load;
      const JointVector to = boom.hammerTorque(w);
      const std::size_t before = test::allocations;
      boom.vibration().advance(kMillisecond, {torque_, to, 0.5 * (torque_ + to)});
      torque_ = to;
      observe(i);
      allocations += test::allocations - before;
      if (i < steps - 1000) continue;
      force.add(boom.vibration().contact(), rock);
      const JointVector oil = boom.vibration().oilTorque().now;
      for (int j = 0; j < 3; ++j) torque.add(oil[j + 1], machine_.hold()[j]);
    }
  }

  Boom boom = test::shippedBoom();
  accuracy::SignalError force, torque;
  std::size_t allocations{};

 private:
  void observe(int i) {
    if (imu_) {
      const Jacobian J = tipJacobian(boom.pose());
      const Eigen::Vector3d imu = machine_.imu(0.1, 0.003), g_T = boom.gravityAtTip();
      const Eigen::Vector3d here = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
      see(0, tipAccelerationReading(J, here, x, g_T, imu[0]), 0.3, 0.3, 0.05);
      see(1, tipAccelerationReading(J, here, z, g_T, imu[1]), 0.3, 0.3, 0.05);
      see(2, tipRateReading(J, Eigen::Vector3d::UnitY(), imu[2]), 0.005, 0.02, 0.005);
    }
    for (int j = 1; j < 4 && i % 2 == 0; ++j)
      see(j, oilTorqueReading(j, machine_.hold()[j - 1] + machine_.noise(100.0)), 200.0, 1000.0, 100.0);
  }
  void see(int channel, VibrationReading reading, double noise, double offset, double walk) {
    reading.noise = noise, reading.offset_std = offset, reading.offset_walk = walk;
    boom.vibration().observe(channel, reading);
  }

  test::VibratingMachine machine_;
  test::PulsingHammer hammer_;
  bool imu_;
  JointVector by_newton_, torque_ = JointVector::Zero(4);
  Eigen::Vector3d load_ = Eigen::Vector3d::Zero();
  double time_{};
};

TEST(ContactFollowing, GivesTheForceOfTheInstantWithAnImu) {
  OnRock run(true);
  run.run(4.0, 1.0);
  EXPECT_LT(run.torque.rms(), 0.04);
  EXPECT_LT(run.force.rmsOfRange(), 0.09);
  EXPECT_GT(run.force.correlation(), 0.86);
  EXPECT_EQ(run.allocations, 0U);
}

TEST(ContactFollowing, AHullThatHangsCountsAsFreeAndLandsAgain) {
  OnRock run(false);
  run.run(3.0, 0.0);
  EXPECT_EQ(run.boom.vibration().contact(), 0.0);
  EXPECT_LT(run.torque.rms(), 0.05);
  run.run(2.0, 1.0);
  EXPECT_GT(run.boom.vibration().contact(), 0.0);
  run.run(4.0, 0.0);
  EXPECT_EQ(run.boom.vibration().contact(), 0.0) << "it was lifted off";
}

}  // namespace
}  // namespace hammer_loads
