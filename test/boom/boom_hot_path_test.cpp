// Everything per sample: no allocation, a few microseconds.
#include <gtest/gtest.h>

#include <chrono>

#include "boom/booms.h"
#include "support/counting_new.h"
#include "support/wall_clock.h"

namespace hammer_loads {
namespace {

using test::kLevel;

/// A kilohertz session: pose, weight and motion torques, vibration, cylinders, the wrench at four links, tip vibration,
/// three sections, joint reactions and pin forces.
class Sampler {
 public:
  Sampler() : boom_(test::shippedBoom()) {}

  void sample() {
    const double time = 1e-3 * count_++;
    JointMotion motion{test::workingPosition(), JointVector::Zero(4), JointVector::Zero(4)};
    for (int j = 0; j < 4; ++j) {
      const double rate = 0.4 + 0.1 * j, angle = rate * time + j;
      motion.position[j] += 0.1 * std::sin(angle);
      motion.velocity[j] = 0.1 * rate * std::cos(angle);
      motion.acceleration[j] = -0.1 * rate * rate * std::sin(angle);
    }
    const double phase = std::fmod(time * 5.0, 1.0);
    const double pulse = phase > 0.9 ? 8e3 * std::sin(31.4 * (phase - 0.9)) : 0.0;
    const Wrench w{Eigen::Vector3d(0.3 * pulse, 0.0, pulse), Eigen::Vector3d(0.0, -0.1 * pulse, 0.0)};

    boom_.moveCompliant(motion, kLevel);
    torque_.from = torque_.to;
    torque_.to = boom_.hammerTorque(w);
    torque_.mean = 0.5 * (torque_.from + torque_.to);
    boom_.vibration().advance(1e-3, torque_);
    boom_.loads(w, false, loads_);
    for (int link = 1; link < 5; ++link) sum_ += wrenchAtLink(boom_.pose(), link, w).torque.y();
    boom_.steelLoads(w, false, steel_);
    sum_ += steel_.section[0].torque.y() + steel_.joint[1].force.x() + steel_.pins[2].rod.x();
    sum_ += loads_.total.sum() + loads_.cylinder[0].force + boom_.tipVibration().acceleration[2];
  }
  double sum() const { return sum_; }

 private:
  Boom boom_;
  TorqueStep torque_{JointVector::Zero(4), JointVector::Zero(4), JointVector::Zero(4)};
  BoomLoads loads_;
  SteelLoads steel_;
  int count_{};
  double sum_{};
};

/// Beside it: modes identified from a hull IMU at the same rate, deviations of everything, flags.
class FullSampler {
 public:
  FullSampler() : boom_(test::shippedBoom()) { boom_.vibration().identify(); }

  void sample() {
    const double time = 1e-3 * count_++;
    JointMotion motion{test::workingPosition(), JointVector::Zero(4), JointVector::Zero(4)};
    for (int j = 0; j < 4; ++j) motion.position[j] += 0.1 * std::sin(0.3 * time + j);
    const double phase = std::fmod(time * 5.0, 1.0);
    const double pulse = phase > 0.9 ? 8e3 * std::sin(31.4 * (phase - 0.9)) : 0.0;
    const Wrench w{Eigen::Vector3d(0.3 * pulse, 0.0, pulse), Eigen::Vector3d(0.0, -0.1 * pulse, 0.0)};
    const WrenchSpread error{1, {Wrench{0.02 * w.force, 0.02 * w.torque}, {}, {}}};

    boom_.moveCompliant(motion, kLevel);
    const JointVector to = boom_.hammerTorque(w);
    const TorqueStep step{torque_, to, 0.5 * (torque_ + to)};
    torque_ = to;
    spread_.follow(boom_.vibration());
    boom_.vibration().advance(1e-3, step);
    spread_.advance(1e-3, step, boom_.spreadTorque(error));
    observe();
    boom_.loads(w, false, loads_);
    boom_.steelLoads(w, false, steel_);
    boom_.deviations(spread_, error, false, deviations_);
    for (std::size_t i = 0; i < 3; ++i) sum_ += boom_.flags(i, loads_);
    sum_ += loads_.total.sum() + steel_.section[0].torque.y() + deviations_.torque.sum();
  }
  double sum() const { return sum_; }

 private:
  void observe() {
    const Jacobian J = tipJacobian(boom_.pose());
    const Boom::TipVibration tip = boom_.tipVibration();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d g_T = boom_.gravityAtTip(), here = Eigen::Vector3d::Zero();
    see(0, tipAccelerationReading(J, here, x, g_T, tip.acceleration[0] - g_T.x()), 0.3);
    see(1, tipAccelerationReading(J, here, z, g_T, tip.acceleration[2] - g_T.z()), 0.3);
    see(2, tipRateReading(J, y, tip.velocity[4]), 0.005);
  }
  void see(int channel, VibrationReading reading, double noise) {
    reading.noise = reading.offset_std = noise;
    boom_.vibration().observe(channel, reading);
  }

  Boom boom_;
  VibrationSpread spread_;
  JointVector torque_ = JointVector::Zero(4);
  BoomLoads loads_;
  SteelLoads steel_;
  BoomDeviations deviations_;
  int count_{};
  double sum_{};
};

template <typename Sampler>
void expectNoAllocation() {
  Sampler sampler;
  sampler.sample();
  const std::size_t before = test::allocations;
  for (int i = 0; i < 10000; ++i) sampler.sample();
  EXPECT_EQ(test::allocations, before);
  EXPECT_TRUE(std::isfinite(sampler.sum()));
}

/// Of the quickest batch [us]: what the machine does when it has nothing else to do.
template <typename Sampler>
double leastTime() {
  Sampler sampler;
  double least = 1e9;
  constexpr int kBatches = 100, kSamples = 500;
  for (int batch = 0; batch < kBatches; ++batch) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kSamples; ++i) sampler.sample();
    const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - start;
    least = std::min(least, spent.count() / kSamples);
  }
  EXPECT_TRUE(std::isfinite(sampler.sum()));
  return least;
}

TEST(BoomHotPath, AllocatesNothing) { expectNoAllocation<Sampler>(); }
TEST(BoomHotPath, AllocatesNothingWithEverythingOn) { expectNoAllocation<FullSampler>(); }

TEST(BoomHotPath, TakesAtMostThreeMicrosecondsASample) {
  const double least = leastTime<Sampler>(), everything = leastTime<FullSampler>();
  RecordProperty("everything_on_us", format("%.2f", everything));
  test::expectTimeWithin(least, 3.0, "[us] a sample of the quickest batch");
}

}  // namespace
}  // namespace hammer_loads
