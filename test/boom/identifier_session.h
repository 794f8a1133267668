/// Mode identifier with a wrong bulk modulus in its boom file, on a machine with noisy sensors.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "boom/vibrating_machine.h"
#include "hammer_loads/boom/mode_identifier.h"
#include "support/counting_new.h"

namespace hammer_loads::test {

enum class Sensor { kImu, kSlowImu, kJoints, kPressures };

/// Runs the machine and an identifier whose boom file gives another bulk modulus.
class IdentifierSession {
 public:
  IdentifierSession(double given_over_true, Sensor sensor, unsigned seed = 1, bool identify = true)
      : parameters_(shippedBoomParameters()), machine_(parameters_, 1e9, seed), sensor_(sensor) {
    parameters_.bulk_modulus = 1e9 * given_over_true;
    boom_.emplace(*Boom::make(shippedUrdf(), parameters_).value);
    const JointVector zero = JointVector::Zero(4);
    boom_->moveCompliant({workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
    if (identify) boom_->vibration().identify();
    boom_->vibration().reset();
    boom_->moveCompliant({workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
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
      Wrench known = w;  // as the identifier receives it
      known.force *= 1.0 + hammer_error, known.torque *= 1.0 + hammer_error;
      const JointVector to = boom_->hammerTorque(known);
      const std::size_t before = allocations;
      boom_->vibration().advance(kMillisecond, {torque_, to, 0.5 * (torque_ + to)});
      torque_ = to;
      observe(i);
      allocations_ += allocations - before;
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
  /// Returns the rms error of the torques hammer + vibration over the rms of the machine's cylinder torques [-].
  double torqueError(double seconds) {
    error_ = size_ = 0.0;
    run(seconds);
    return std::sqrt(error_ / size_);
  }

  BoomParameters parameters_;
  VibratingMachine machine_;
  Sensor sensor_;
  std::optional<Boom> boom_;
  std::size_t allocations_{};
  std::size_t late_{};  ///< delay of the IMU in readings
  std::size_t lead_{};  ///< lead of the hammer over the compared torques in steps

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
    reading.noise = noise, reading.offset_std = offset, reading.offset_walk = walk;
    boom_->vibration().observe(channel, reading);
  }

  PulsingHammer hammer_;
  Jacobian J_;
  Eigen::Vector3d load_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 4> readings_{load_, load_, load_, load_};  ///< readings of the IMU, newest first
  std::array<Eigen::Vector3d, 4> holds_{readings_};                      ///< torques of the cylinders, newest first
  JointVector torque_ = JointVector::Zero(4);
  double time_{}, error_{}, size_{};
};

}  // namespace hammer_loads::test
