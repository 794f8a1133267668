// Frequencies and damping from noisy sensors on a boom that a hand-made chain vibrates: its own mass matrix, stiffness
// from the cylinders' triangles by differences, damping by Rayleigh, integrated in small steps.
#include "hammer_loads/boom/mode_identifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "boom/vibrating_machine.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

using test::kMillisecond;

using test::kGravity;

enum class Sensor { kImu, kSlowImu, kJoints, kPressures };

/// Runs the machine and an identifier whose boom file gives another bulk modulus.
class Session {
 public:
  Session(double given_over_true, Sensor sensor, unsigned seed = 1, bool identify = true)
      : parameters_(test::shippedBoomParameters()), machine_(parameters_, 1e9, seed), sensor_(sensor) {
    parameters_.bulk_modulus = 1e9 * given_over_true;
    boom_.emplace(*Boom::make(test::shippedUrdf(), parameters_).value);
    const JointVector zero = JointVector::Zero(4);
    boom_->moveCompliant({test::workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
    if (identify) boom_->vibration().identify();
    boom_->vibration().rest();
    boom_->moveCompliant({test::workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
    J_ = tipJacobian(boom_->pose());
  }

  void run(double seconds, double hammer_error = 0.0) {
    const int steps = static_cast<int>(seconds / kMillisecond);
    for (int i = 0; i < steps; ++i) {
      time_ += kMillisecond;
      const Wrench w = hammer_.at(time_);
      const Eigen::Vector3d load = machine_.load(w);
      machine_.step(load_, load);
      load_ = load;
      Wrench known = w;  // what the identifier is given of it
      known.force *= 1.0 + hammer_error, known.torque *= 1.0 + hammer_error;
      const JointVector to = boom_->hammerTorque(known);
      const std::size_t before = test::allocations;
      boom_->vibration().advance(kMillisecond, {torque_, to, 0.5 * (torque_ + to)});
      torque_ = to;
      observe(i);
      allocations_ += test::allocations - before;
      const JointVector hold = to + boom_->vibration().torque();
      std::rotate(holds_.rbegin(), holds_.rbegin() + 1, holds_.rend());
      holds_.front() = machine_.hold();
      error_ += (hold.tail<3>() - holds_[lead_]).squaredNorm();
      size_ += holds_[lead_].squaredNorm();
    }
  }
  double frequencyError(int mode) const { return boom_->vibration().mode(mode).omega / machine_.omega[mode] - 1.0; }
  double dampingError(int mode) const { return boom_->vibration().mode(mode).zeta / machine_.zeta[mode] - 1.0; }

  const ModeIdentifier& identifier() const { return *boom_->vibration().identifier(); }
  /// Of hammer + vibration on the joints against what the machine's cylinders carry, over some seconds, of its rms.
  double torqueError(double seconds) {
    error_ = size_ = 0.0;
    run(seconds);
    return std::sqrt(error_ / size_);
  }

  BoomParameters parameters_;
  test::VibratingMachine machine_;
  Sensor sensor_;
  std::optional<Boom> boom_;
  std::size_t allocations_{};
  std::size_t late_{};  ///< readings by which the IMU is late
  std::size_t lead_{};  ///< by so many the hammer leads the time in which torques are judged

 private:
  void observe(int i) {
    if (sensor_ == Sensor::kImu || (sensor_ == Sensor::kSlowImu && i % 5 == 0)) observeImu();
    if (sensor_ == Sensor::kJoints && i % 5 == 0) observeJoints();
    if (sensor_ == Sensor::kPressures && i % 2 == 0) observePressures();
  }
  void observeImu() {
    std::rotate(readings_.rbegin(), readings_.rbegin() + 1, readings_.rend());
    readings_.front() = machine_.imu(0.3, 0.005);
    const Eigen::Vector3d imu = readings_[late_];
    const Eigen::Vector3d g_T = boom_->gravityAtTip(), here = Eigen::Vector3d::Zero();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
    VibrationReading along_x = tipAccelerationReading(J_, here, x, g_T, imu[0]),
                     along_z = tipAccelerationReading(J_, here, z, g_T, imu[1]);
    along_x.neglected = along_z.neglected = 1.0;  // as in the pipeline, whose links move in the hull
    VibrationReading turning = tipRateReading(J_, y, imu[2]);
    for (VibrationReading* one : {&along_x, &along_z, &turning}) one->clock = Clock::kImu;
    see(0, along_x, 0.3, 0.3, 0.05);
    see(1, along_z, 0.3, 0.3, 0.05);
    see(2, turning, 0.005, 0.02, 0.005);
  }
  void observeJoints() {
    for (int j = 1; j < 4; ++j) {
      const double slow = 0.002 * std::sin(0.5 * time_ + j);  // of which joint_states alone know nothing
      see(j, jointAngleReading(j, machine_.displacement()[j - 1] + slow + machine_.noise(2e-4)), 2e-4, 0.01, 0.002);
    }
  }
  void observePressures() {
    for (int j = 1; j < 4; ++j) {
      const double hold = machine_.hold()[j - 1] * 1.0 + machine_.noise(200.0);
      see(j, oilTorqueReading(j, hold), 200.0, 1000.0, 100.0);
    }
  }
  void see(int channel, VibrationReading reading, double noise, double offset, double walk) {
    reading.noise = noise, reading.offset_deviation = offset, reading.offset_walk = walk;
    boom_->vibration().observe(channel, reading);
  }

  test::PulsingHammer hammer_;
  Jacobian J_;
  Eigen::Vector3d load_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 4> readings_{load_, load_, load_, load_};  ///< of the IMU, the newest first
  std::array<Eigen::Vector3d, 4> holds_{readings_};                      ///< likewise of the cylinders
  JointVector torque_ = JointVector::Zero(4);
  double time_{}, error_{}, size_{};
};

struct WrongOil {
  double given_over_true;
  Sensor sensor;
  const char* name;
  friend std::ostream& operator<<(std::ostream& out, const WrongOil& oil) { return out << oil.name; }
};
class Oil : public testing::TestWithParam<WrongOil> {};

TEST_P(Oil, IsIdentifiedFromANoisySensor) {
  const WrongOil& oil = GetParam();
  double worst_frequency = 0.0, worst_torque = 0.0;
  for (unsigned seed : {1U, 2U, 3U}) {
    Session run(oil.given_over_true, oil.sensor, seed);
    EXPECT_FALSE(run.identifier().identified());
    EXPECT_GT(std::abs(run.frequencyError(0)), 0.14);
    run.run(12.0);
    EXPECT_TRUE(run.identifier().identified());
    // The two modes that carry the vibration; the third, at 20 Hz and more, moves a joint by less than its sensor's
    // noise.
    for (int k = 0; k < 2; ++k) {
      EXPECT_LT(std::abs(run.frequencyError(k)), 0.01) << k;
      EXPECT_LT(std::abs(run.dampingError(k)), 0.15) << k;
      worst_frequency = std::max(worst_frequency, std::abs(run.frequencyError(k)));
    }
    EXPECT_LT(std::abs(run.frequencyError(2)), 0.08);
    EXPECT_EQ(run.allocations_, 0U);
    worst_torque = std::max(worst_torque, run.torqueError(4.0));
  }
  EXPECT_LT(worst_torque, 0.05);
  Session given(oil.given_over_true, oil.sensor, 1, false);
  given.run(12.0);
  const double torque_as_given = given.torqueError(4.0);
  EXPECT_GT(torque_as_given, 0.25);
  RecordProperty("frequency_error", format("%.2g", worst_frequency));
  RecordProperty("torque_error", format("%.2g", worst_torque));
  RecordProperty("torque_error_as_given", format("%.2g", torque_as_given));
}

INSTANTIATE_TEST_SUITE_P(BulkModulus, Oil,
                         testing::Values(WrongOil{0.7, Sensor::kImu, "SoftImu"},
                                         WrongOil{1.4, Sensor::kImu, "StiffImu"},
                                         WrongOil{0.7, Sensor::kSlowImu, "SoftImu200Hz"},
                                         WrongOil{1.4, Sensor::kSlowImu, "StiffImu200Hz"},
                                         WrongOil{0.7, Sensor::kJoints, "SoftJoints200Hz"},
                                         WrongOil{1.4, Sensor::kJoints, "StiffJoints200Hz"},
                                         WrongOil{0.7, Sensor::kPressures, "SoftPressures"},
                                         WrongOil{1.4, Sensor::kPressures, "StiffPressures"}),
                         [](const auto& named) { return named.param.name; });

/// Of oil and delay neither is taken for the other.
TEST(ModeIdentifier, FindsByWhatStampsAreLate) {
  for (double given_over_true : {0.7, 1.4}) {
    for (std::size_t late : {0U, 1U, 2U, 3U}) {
      Session run(given_over_true, Sensor::kImu);
      run.late_ = late;
      run.run(12.0);
      const ModeIdentifier& found = run.identifier();
      const double delay = kMillisecond * static_cast<double>(late);
      EXPECT_NEAR(found.delay(Clock::kImu), delay, 0.1 * kMillisecond + 0.1 * delay) << late;
      EXPECT_LT(found.delayDeviation(Clock::kImu), 0.1 * kMillisecond + 0.2 * delay) << late;
      for (int k = 0; k < 2; ++k) EXPECT_LT(std::abs(run.frequencyError(k)), 0.01) << late << k;
      EXPECT_LT(run.torqueError(4.0), 0.05) << late;
    }
  }
}

/// Only as much of a delay as is expected of the crank, and none where the sensor is right.
TEST(ModeIdentifier, TakesFromADelayWhatTheCrankLeads) {
  struct Case {
    std::size_t late;
    CrankLead expected;  ///< [ms]
    double lead;         ///< [ms]
  };
  for (const Case& c : {Case{1, {1.0, 0.3}, 1.0}, Case{1, {0.9, 0.3}, 1.0}, Case{1, {0.0, 0.3}, 0.03},
                        Case{3, {1.0, 0.3}, 1.0}, Case{0, {1.0, 0.3}, 0.0}, Case{1, {-1.0, 0.3}, 0.0}}) {
    Session run(1.0, Sensor::kImu);
    run.late_ = c.late;
    run.boom_->vibration().expectCrankLead({kMillisecond * c.expected.mean, kMillisecond * c.expected.deviation});
    run.run(8.0);
    const ModeIdentifier& found = run.identifier();
    const double late = kMillisecond * static_cast<double>(c.late), lead = kMillisecond * c.lead;
    EXPECT_NEAR(found.crankLead(), lead, 0.15 * kMillisecond) << c.late << " " << c.expected.mean;
    EXPECT_NEAR(found.crankLead() + found.delay(Clock::kImu), late, 0.1 * kMillisecond + 0.1 * late);
    run.lead_ = static_cast<std::size_t>(std::lround(c.lead));
    EXPECT_LT(run.torqueError(4.0), 0.02) << c.late << " " << c.expected.mean << ": in the crank's time it is 0.033";
  }
}

/// Readings of one instant in one call or each in its own: pressures are the same, an IMU's differ by the second order.
TEST(ModeIdentifier, ReadingsTogetherSayWhatTheySayOneByOne) {
  for (const Clock clock : {Clock::kPressures, Clock::kImu}) {
    Session run(0.7, Sensor::kPressures);
    run.run(1.0);  // frequencies are still being learned
    const Vibration& before = run.boom_->vibration();
    Vibration together = before, apart = before;
    std::array<VibrationReading, 3> readings;
    for (int j = 1; j < 4; ++j) {
      VibrationReading& one = readings[static_cast<std::size_t>(j - 1)];
      one = oilTorqueReading(j, run.machine_.hold()[j - 1] + 50.0 * j);
      one.noise = 200.0, one.offset_deviation = 1000.0, one.clock = clock;
      one.channel = j == 3 ? 7 : j;  // one that has not been used
    }
    together.observe(readings.data(), readings.size());
    for (const VibrationReading& one : readings) apart.observe(one.channel, one);
    const double known = clock == Clock::kPressures ? 1e-9 : 0.1;  // of the change
    const ModeIdentifier &a = *together.identifier(), &b = *apart.identifier(), &old = *before.identifier();
    EXPECT_LT((a.displacement() - b.displacement()).norm(), known * (a.displacement() - old.displacement()).norm());
    EXPECT_LT((a.velocity() - b.velocity()).norm(), known * (a.velocity() - old.velocity()).norm());
    for (int k = 0; k < 3; ++k) {
      const double change = std::abs(a.frequencyRatio(k) - old.frequencyRatio(k));
      EXPECT_LT(std::abs(a.frequencyRatio(k) - b.frequencyRatio(k)), known * change + 1e-12) << k;
      EXPECT_NEAR(a.frequencyDeviation(k) / b.frequencyDeviation(k), 1.0, known) << k;
      EXPECT_GT(change, 1e-6) << k;
    }
  }
}

TEST(ModeIdentifier, WithoutReadingsNothingIsFound) {
  Session run(0.7, Sensor::kImu);
  const double before = run.identifier().frequencyDeviation(0);
  const JointVector torque = JointVector::Constant(4, 1e3);
  for (int i = 0; i < 5000; ++i) run.boom_->vibration().advance(kMillisecond, {torque, torque, torque});
  EXPECT_EQ(run.identifier().frequencyRatio(0), 1.0);
  EXPECT_GE(run.identifier().frequencyDeviation(0), before);
  EXPECT_FALSE(run.identifier().identified());
}

TEST(ModeIdentifier, SurvivesNonsenseAndAForceThatIsAFewPercentWrong) {
  Session run(0.7, Sensor::kImu);
  run.run(12.0, 0.05);
  // The third mode hangs on the same three stiffnesses, and is hardly moved.
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(run.frequencyError(k)), k < 2 ? 0.025 : 0.04) << k;
  // A reading of a thousand times its size moves little; one that is no number nothing.
  const double ratio = run.identifier().frequencyRatio(0);
  VibrationReading reading = jointAngleReading(1, 100.0);
  reading.noise = 1e-4, reading.offset_deviation = 0.01;
  run.boom_->vibration().observe(5, reading);
  EXPECT_NEAR(run.identifier().frequencyRatio(0), ratio, 0.02);
  reading.value = std::nan("");
  run.boom_->vibration().observe(5, reading);
  reading.value = 1e308;
  reading.velocity.setConstant(1e200);
  run.boom_->vibration().observe(5, reading);
  EXPECT_TRUE(std::isfinite(run.identifier().frequencyRatio(0)));
  run.boom_->vibration().observe(-1, reading);
  run.boom_->vibration().observe(ModeIdentifier::kMaxChannels, reading);
}

TEST(ModeIdentifier, AnotherPoseKeepsWhatIsKnown) {
  Session run(0.7, Sensor::kImu);
  run.run(6.0);
  const JointVector x = run.identifier().displacement(), v = run.identifier().velocity(), zero = JointVector::Zero(4);
  const double of_arm = run.identifier().oilCovariance(1, 1), with_hammer = run.identifier().oilCovariance(1, 2);
  Boom right = test::shippedBoom();  // of the machine's oil
  const auto overRight = [&](const JointVector& position) {
    right.moveCompliant({position, zero, zero}, {0.0, 0.0, -kGravity});
    return JointVector(run.boom_->vibration().modes().omega.cwiseQuotient(right.vibration().modes().omega));
  };
  const JointVector before = overRight(test::workingPosition());
  const JointVector position = test::workingPosition() + test::joints({0.0, 0.1, -0.1, 0.05});
  run.boom_->moveCompliant({position, zero, zero}, {0.0, 0.0, -kGravity});
  EXPECT_LT((run.identifier().displacement() - x).norm(), 1e-12);
  EXPECT_LT((run.identifier().velocity() - v).norm(), 1e-11);
  EXPECT_EQ(run.identifier().oilCovariance(1, 1), of_arm);
  EXPECT_EQ(run.identifier().oilCovariance(1, 2), with_hammer);
  EXPECT_LT((overRight(position) - before).cwiseAbs().maxCoeff(), 0.003);
  const JointVector omega = run.boom_->vibration().modes().omega;
  run.boom_->vibration().rest();
  EXPECT_TRUE(run.identifier().displacement().isZero(0.0));
  EXPECT_EQ(run.boom_->vibration().modes().omega, omega);
}

TEST(ModeIdentifier, ModesAreThoseOfTheOilFound) {
  Session run(0.7, Sensor::kPressures);
  run.run(12.0);
  Boom right = test::shippedBoom();  // of the machine's oil
  right.moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  const BoomModes& modes = run.boom_->vibration().modes();
  const auto overRight = [&] { return modes.given_omega[0] / right.vibration().modes().given_omega[0]; };
  EXPECT_NEAR(overRight(), std::sqrt(0.7), 0.02);
  const JointVector omega = modes.omega;
  run.boom_->moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  EXPECT_NEAR(overRight(), 1.0, 0.02);
  EXPECT_LT((modes.omega - omega).cwiseQuotient(omega).cwiseAbs().maxCoeff(), 0.002) << "what is found stays";
}

TEST(VibrationSpread, WaitsWhereReadingsShowTheMotion) {
  Session run(0.7, Sensor::kImu);
  run.run(6.0);
  const Vibration& vibration = run.boom_->vibration();
  ASSERT_TRUE(vibration.followsReadings());
  VibrationSpread spread;
  spread.follow(vibration);
  const auto damped = [&] { return spread.accelerationDifference(VibrationSpread::kDamped, vibration.acceleration()); };
  const JointVector difference = damped(), much = JointVector::Constant(4, 1e5);
  spread.advance(kMillisecond, {much, much, much}, LoadSpread(4, 0));
  EXPECT_EQ(damped(), difference);
  JointVector expected(3);  // the same motion with more damping
  for (int k = 0; k < 3; ++k) {
    const Mode mode = vibration.mode(k);
    const double more = std::exp(spread.deviation(k).damping) - 1.0;
    expected[k] = -2.0 * more * mode.zeta * mode.omega * vibration.motion(k).v;
  }
  EXPECT_LT((jointsOf(vibration.modes(), expected) - difference).norm(), 1e-9 * difference.norm());
  run.boom_->vibration().rest();  // a gap: readings show nothing any more
  spread.follow(vibration);
  spread.advance(kMillisecond, {much, much, much}, LoadSpread(4, 0));
  EXPECT_GT(damped().norm(), 1.0);
}

}  // namespace
}  // namespace hammer_loads
