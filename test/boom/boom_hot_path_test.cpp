// Everything per sample: no allocation, a few microseconds.
#include <gtest/gtest.h>

#include <chrono>

#include "boom/booms.h"
#include "support/counting_new.h"
#include "support/wall_clock.h"

namespace hammer_loads {
namespace {

const Eigen::Vector3d kLevel(0.0, 0.0, -9.80665);

/// A kilohertz session: pose, weight and motion torques, vibration, cylinders, the wrench at four links, tip vibration.
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
    sum_ += loads_.total.sum() + loads_.cylinder[0].force + boom_.tipVibration().acceleration[2];
  }
  double sum() const { return sum_; }

 private:
  Boom boom_;
  TorqueStep torque_{JointVector::Zero(4), JointVector::Zero(4), JointVector::Zero(4)};
  BoomLoads loads_;
  int count_{};
  double sum_{};
};

TEST(BoomHotPath, AllocatesNothing) {
  Sampler sampler;
  sampler.sample();
  const std::size_t before = test::allocations;
  for (int i = 0; i < 10000; ++i) sampler.sample();
  EXPECT_EQ(test::allocations, before);
  EXPECT_TRUE(std::isfinite(sampler.sum()));
}

TEST(BoomHotPath, TakesAtMostThreeMicrosecondsASample) {
  Sampler sampler;
  double least = 1e9, mean = 0.0;
  constexpr int kBatches = 100, kSamples = 500;
  for (int batch = 0; batch < kBatches; ++batch) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kSamples; ++i) sampler.sample();
    const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - start;
    least = std::min(least, spent.count() / kSamples);
    mean += spent.count() / kSamples / kBatches;
  }
  RecordProperty("least_us", format("%.2f", least));
  RecordProperty("mean_us", format("%.2f", mean));
  EXPECT_TRUE(std::isfinite(sampler.sum()));
  test::expectTimeWithin(least, 3.0, "[us] a sample of the quickest batch");
}

}  // namespace
}  // namespace hammer_loads
