/// What sensors see of the boom's vibration, as readings for its ModeIdentifier.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/joint_buffer.h"

namespace hammer_loads {

/// Each reading is given once, at the crank sample that follows it. Joint angles count above 100 Hz and while the joint
/// stands: a moving one hides its vibration. No allocation.
class ModeObserver {
 public:
  /// imu_position: from D, axes of hammer_hull [m].
  explicit ModeObserver(const Eigen::Vector3d& imu_position) : imu_position_(imu_position) {}

  /// The unit's reading at the sample in the hull's axes, if a new one has come.
  void imu(Boom& boom, const JointMotion& motion, const ImuReading& reading) noexcept;
  void joints(Boom& boom, StampNs sample, double step, const JointBuffer& joints) noexcept;
  /// loads: those of the sample, rigid or not.
  void pressures(Boom& boom, StampNs sample, const CylinderPressures& pressures, const BoomLoads& loads) noexcept;

 private:
  struct JointTrack {
    StampNs stamp{};
    double position{}, speed{};  ///< speed: mean over some 0.5 s [rad/s]
  };
  static constexpr int kImuChannels = 3;

  Eigen::Vector3d imu_position_;
  std::array<JointTrack, kMaxJoints> joints_;
  std::array<std::uint64_t, kMaxJoints> pressures_{};  ///< CylinderPressures::count() at the last sample
};

}  // namespace hammer_loads
