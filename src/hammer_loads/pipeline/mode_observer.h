/// Conversion of the boom's sensors to readings for its ModeIdentifier.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/pipeline/held_pose.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/joint_buffer.h"

namespace hammer_loads {

/// Each reading is passed on once, at the crank sample that follows it. Joint sensors also measure the vibration: the
/// operator's motion is the part of their angles below some 0.3 Hz. Joint angles are used if they are sampled above 100
/// Hz, with less weight the faster a joint moves. While the operator drives a joint fast, 2 s after that and 1 s after
/// the start only pressures count. No allocation.
class ModeObserver {
 public:
  /// imu_position: from D, axes of hammer_hull [m].
  explicit ModeObserver(const Eigen::Vector3d& imu_position) : imu_position_(imu_position) {}

  /// Takes a new reading in the hull's axes, which waits until the sensors' time reaches its stamp.
  void imu(Boom& boom, const HeldPose& held, StampNs sample, double step, const StampedImuReading& reading) noexcept;
  void joints(Boom& boom, const HeldPose& held, StampNs sample, double step, const JointBuffer& joints) noexcept;
  void pressures(Boom& boom, const HeldPose& held, StampNs sample, const CylinderPressures& pressures) noexcept;

 private:
  struct JointTrack {
    StampNs stamp{};
    double position{};
  };
  static constexpr int kImuChannels = 3;

  void update(Boom& boom, const HeldPose& held, double ahead, const ImuReading& reading) const noexcept;

  Eigen::Vector3d imu_position_;
  WaitingReadings imu_;
  std::array<JointTrack, kMaxJoints> joints_;
  std::array<std::uint64_t, kMaxJoints> pressures_{};  ///< CylinderPressures::count() at the last sample
};

}  // namespace hammer_loads
