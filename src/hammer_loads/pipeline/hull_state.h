/// The hull's state: its pitch, its own motion and the source of that.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/hull_gravity.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/hull_motion_filter.h"
#include "hammer_loads/pipeline/imu_trust.h"
#include "hammer_loads/pipeline/unmeasured_hull.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// Readings of the hull's IMU since the start.
struct ImuCounts {
  std::uint64_t accepted{};
  std::array<std::uint64_t, static_cast<std::size_t>(ImuRefusal::kCount)> refused{};
  std::uint64_t missed{};  ///< crank samples at which it did not show the hull's motion
};

/// Owns gravity and IMU, and the boom's last vibration. If the IMU is missing, overdue or rejected, the hull's motion
/// is that of the boom's vibration, provided that sensors have identified the oil.
class HullState {
 public:
  struct Motion {
    HullMotion motion;  ///< at the sample
    bool moves{};       ///< true if it includes the hull's own motion
    /// Covariance of an IMU's motion, or of that of a boom whose oil the sensors identify. Zero for other sources.
    HullMotionCovariance covariance = HullMotionCovariance::Zero();
  };

  HullState(const HammerParameters& hammer, const PipelineSettings& settings, const std::optional<Boom>& boom);

  /// Takes boom joint angles, any subset in any order. Returns true if a pitch joint was among them.
  bool joints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;
  std::optional<ImuRefusal> imu(StampNs stamp, const ImuReading& reading) noexcept;

  /// Predicts the motion before a sample is processed (by the boom's vibration: that of the sample before).
  const HullMotion& predict(StampNs stamp) noexcept;
  /// Notes a blow within the step to a sample. Call before follow().
  void struck(StampNs blow) noexcept { imu_.struck(blow); }
  /// Updates the motion after a sample was processed, with the step's load. beside: DisplacedLinks at the sample.
  void follow(StampNs sample, const WrenchHistory& step, const HullWrench& beside) noexcept;
  /// Prior of the motion where nothing measures it; null: the hull is held.
  const UnmeasuredHull* prior() const noexcept { return source_ == HullMotionSource::kFixed ? nullptr : &prior_; }
  bool followsLoad() const noexcept { return source_ == HullMotionSource::kImu; }  ///< follow() has an effect
  /// Velocity of D at the last blow by the IMU; none where it is not known.
  std::optional<TipVelocity> speedAtBlow() const noexcept {
    return imu_trust_.isLost() ? std::nullopt : imu_.speedAtBlow();
  }
  /// The IMU's reading at the sample in the hull's axes, if there is a new one since the last call. If its stamps
  /// jitter, which would distort the interpolation, it is the last reading itself.
  std::optional<StampedImuReading> newImuReading(StampNs sample, bool stamps_jitter) noexcept;
  /// Takes the wrench on the hull at a sample and its duration [s], for the motion of an unmeasured hull.
  void carry(const HullWrench& load, double duration) noexcept;
  /// Takes the vibration of the boom at the sample; null: not known. Call after carry().
  void vibrates(const BoomFollower* boom) noexcept;
  /// Notes a gap before the coming samples; the boom is at rest.
  void rest() noexcept { vibration_.reset(), vibration_doubt_.reset(); }

  const Motion& motion() const noexcept { return now_; }
  const HullPitch& pitch() const noexcept { return weight_.pitch(); }
  bool pitchKnown() const noexcept { return pitch_known_; }
  bool anglesLookLikeDegrees() const noexcept { return in_degrees_; }
  const Gravity& gravity() const noexcept { return weight_.gravity(); }  ///< by the joint angles
  const ImuCounts& imuCounts() const noexcept { return imu_counts_; }
  const ImuTrust& imuTrust() const noexcept { return imu_trust_; }

 private:
  void weigh() noexcept;
  void find(StampNs stamp) noexcept;
  void findByBoom() noexcept;
  std::optional<KnownHullMotion> measured(StampNs stamp) const noexcept;
  void forgetReading(double part) noexcept;
  HullMotionCovariance usualMotion() const noexcept;
  HullMotionCovariance unmeasured() const noexcept;

  HullMotionSource source_;
  UnmeasuredHull prior_;
  RunningMean<Eigen::Vector3d> load_{look_back::kTenTurns, Eigen::Vector3d::Zero()};         ///< carry()
  RunningMean<Eigen::Vector3d> load_square_{look_back::kTenTurns, Eigen::Vector3d::Zero()};  ///< mean squares
  HullGravity weight_;
  HullImu imu_;
  HullMotionFilter filter_;
  std::optional<HullMobility> mobility_;  ///< mobility of the boom; none: followsLoad() is not wanted, or no boom
  ImuTrust imu_trust_;
  ImuCounts imu_counts_;
  std::optional<HullMotion> vibration_;  ///< boom's tip at the last sample, without weight; none: not known
  std::optional<HullMotionCovariance> vibration_doubt_;  ///< none: not requested while an IMU was in use
  Motion now_;
  std::uint64_t imu_taken_{};  ///< readings accepted up to the last newImuReading()
  /// known_: false if the hull's motion is to be that of IMU or boom and is not known, or if the IMU is rejected. Then
  /// the weight is by the joint angles, with the vibration of a boom whose oil is identified.
  bool known_{true}, by_imu_{};
  bool pitch_known_{}, in_degrees_{};  ///< state at the last message of joints
};

}  // namespace hammer_loads
