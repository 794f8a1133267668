/// The hull's state: gravity in its axes, its motion and the source of this motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/hull_motion_filter.h"
#include "hammer_loads/pipeline/sensor_trust.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Sum of the pitch joints' latest angles, each with its sign (contract: boom + arm + hammer, all about +y), and an
/// offset. Messages may hold any subset of joints in any order.
class HullPitch {
 public:
  /// Largest accepted angle [rad]: degrees are accepted and recognised, garbage is refused.
  static constexpr double kMostAngle = 1e4;
  // Limit: kMostAngle

  /// initial: pitch until all joints have been received [rad].
  HullPitch(std::vector<std::string> joints, double initial) : HullPitch(std::move(joints), {}, 0.0, initial) {}
  /// signs: 1 about +y, -1 about -y, one per joint; empty: all 1. offset: pitch with all of them at zero [rad].
  HullPitch(std::vector<std::string> joints, std::vector<int> signs, double offset, double initial);

  /// Takes the pitch joints of a message. Returns true if there was any. Angles that are not finite or beyond 1e4 rad
  /// are refused and counted.
  bool update(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;

  double pitch() const noexcept { return pitch_; }             ///< [rad]
  bool known() const noexcept { return unheard_ == 0; }        ///< every pitch joint has been received
  std::uint64_t refused() const noexcept { return refused_; }  ///< joint angles refused
  /// Returns true if the latest angle of a joint exceeds a whole revolution, which no boom reaches.
  bool looksLikeDegrees() const noexcept;
  /// Returns the joints that have not been received yet, for diagnostics.
  std::vector<std::string> unheard() const;

 private:
  std::vector<std::string> joints_;
  std::vector<int> signs_;
  double offset_;
  std::vector<double> angles_;
  std::vector<bool> heard_;
  std::size_t unheard_;
  double pitch_;
  std::uint64_t refused_{};
};

/// Gravity from axes, zeros, fixed tilts and swing of a boom or of a description with the pitch joints, once these have
/// been received; other joints are at zero until received. Otherwise the sum of the pitch joints is used.
class HullGravity {
 public:
  HullGravity(const PipelineSettings& settings, const std::optional<Boom>& boom);

  /// Takes boom joint angles, any subset in any order. Returns true if any was used.
  bool joints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;

  /// Returns positions of the chain's joints once all of them have been received; null before, or without a chain.
  const JointVector* position() const noexcept { return chain_ && allHeard() ? &position_ : nullptr; }
  const Gravity& gravity() const noexcept { return gravity_; }  ///< hull axes [m/s2]
  const HullPitch& pitch() const noexcept { return pitch_; }

 private:
  bool readPositions(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;
  void find() noexcept;
  bool allHeard() const noexcept;

  HullPitch pitch_;
  Eigen::Vector3d g_B_;  ///< in the root's axes [m/s2]
  std::optional<Chain> chain_;
  double beyond_{};           ///< pitch of the hull against the chain's tip [rad]
  JointVector zeros_;         ///< readings at the chain's zeros
  JointVector position_;      ///< positions of the chain's joints; zero before they are received
  std::vector<bool> heard_;   ///< true for each joint that was received
  bool pitch_is_of_chain_{};  ///< the pitch joints are joints of the chain
  Gravity gravity_;
};

/// A boom holds the hull with an unknown stiffness. The motion of a free hull of `hull_mass_kg` is therefore multiplied
/// by the amplification of a resonance, with any phase.
class UnmeasuredHull {
 public:
  explicit UnmeasuredHull(const HammerParameters& hammer) noexcept
      : mass_(hammer.hull_mass > 0.0 ? hammer.hull_mass : kUsualMass * hammer.rocker_mass),
        resonance_(kResonance *
                   std::hypot(1.0, hammer.hull_mass > 0.0 ? hammer.hull_mass_std / hammer.hull_mass : kUsualDeviation)),
        striking_distance_(hammer.striking_distance),
        reflected_(square(hammer.rocker_mass * hammer.rocker_com_distance) / hammer.rocker_inertia_about_pivot) {}

  /// Returns the covariance of the motion. scatter: variances of the load's components [N2, N2, N2 m2].
  HullMotionCovariance motion(const Eigen::Vector3d& scatter) const noexcept {
    const double factor = square(resonance_ / mass_), force = factor * (scatter[0] + scatter[1]);
    HullMotionCovariance covariance = HullMotionCovariance::Zero();
    covariance(0, 0) = covariance(1, 1) = force;
    covariance(3, 3) = factor * scatter[2] / square(square(kGyration)) + force / square(kGyration);
    return covariance;
  }
  /// Returns the standard deviation of the striking point's velocity along z at a blow [m/s]. swing: momentum that the
  /// links' load has given a free hull by then, about the mean of the revolution (TurnRecorder::swing()).
  double speedAtBlow(const LinkMomentum& swing) const noexcept {
    return kSpeedResonance / kResonance * resonance_ / mass_ *
           std::hypot(swing.z, striking_distance_ / square(kGyration) * swing.about_d);
  }
  /// Returns the relative standard deviation of the rocker's inertia reflected to the crank at a blow, part of which a
  /// yielding hull takes. Blows are too short for a resonance.
  double reflectedInertia() const noexcept { return reflected_ / mass_; }

 private:
  static constexpr double kUsualMass = 10.0;      ///< times the rocker's mass, if no hull mass is given
  static constexpr double kUsualDeviation = 0.5;  ///< relative, for that mass
  static constexpr double kGyration = 0.4;        ///< [m] about D
  /// Amplification of a free hull's motion where the boom's frequency is near that of the blows: for the acceleration,
  /// and for the velocity, of which the first harmonic is a larger part.
  static constexpr double kResonance = 2.0, kSpeedResonance = 3.0;
  // Prior: kUsualMass, kUsualDeviation, kGyration, kResonance, kSpeedResonance

  double mass_;               ///< [kg]
  double resonance_;          ///< amplification, including the deviation of the mass
  double striking_distance_;  ///< [m]
  double reflected_;          ///< mass by which a free hull would halve it [kg]
};

/// Readings of the hull's IMU since the start.
struct ImuCounts {
  std::uint64_t accepted{};
  std::array<std::uint64_t, static_cast<std::size_t>(ImuRefusal::kCount)> refused{};
  std::uint64_t missed{};  ///< crank samples without a known motion of the hull
};

/// Owns gravity and IMU, and the boom's last vibration. If the IMU is missing, overdue or rejected, the boom's
/// vibration replaces its motion, provided that sensors have identified the oil.
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

  /// Predicts the motion before a sample is processed; for the boom's vibration it is that of the previous sample.
  const HullMotion& predict(StampNs stamp) noexcept;
  /// Notes a blow within the step to a sample. Call before follow().
  void struck(StampNs blow) noexcept { imu_.struck(blow); }
  /// Updates the motion after a sample was processed, with the step's load. beside: DisplacedLinks at the sample.
  void follow(StampNs sample, const WrenchHistory& step, const HullWrench& other_load) noexcept;
  /// Returns the prior of the motion where nothing measures it; null: the hull is held.
  const UnmeasuredHull* prior() const noexcept { return source_ == HullMotionSource::kFixed ? nullptr : &prior_; }
  bool followsLoad() const noexcept { return source_ == HullMotionSource::kImu; }  ///< follow() has an effect
  /// Returns the velocity of D at the last blow from the IMU; empty where it is not known.
  std::optional<TipVelocity> speedAtBlow() const noexcept {
    return imu_trust_.isLost() ? std::nullopt : imu_.speedAtBlow();
  }
  /// Returns a new IMU reading at the sample, in the hull's axes; empty without a new one since the last call. If its
  /// stamps jitter, which would distort the interpolation, or if it is late, it is the last reading itself. A late one
  /// that is older than most_age [s] is omitted.
  std::optional<StampedImuReading> newImuReading(StampNs sample, bool stamps_jitter, double most_age) noexcept;
  /// Takes the wrench on the hull at a sample and its duration [s], for the motion of an unmeasured hull.
  void carry(const HullWrench& load, double duration) noexcept;
  /// Takes the vibration of the boom at the sample; null: not known. Call after carry().
  void vibrates(const BoomFollower* boom) noexcept;
  /// Notes a gap before the coming samples; the boom is at rest.
  void clearVibration() noexcept { vibration_.reset(), vibration_covariance_.reset(); }

  const Motion& motion() const noexcept { return now_; }
  const HullPitch& pitch() const noexcept { return weight_.pitch(); }
  bool pitchKnown() const noexcept { return pitch_known_; }
  bool anglesLookLikeDegrees() const noexcept { return in_degrees_; }
  const Gravity& gravity() const noexcept { return weight_.gravity(); }  ///< from the joint angles
  const ImuCounts& imuCounts() const noexcept { return imu_counts_; }
  const ImuTrust& imuTrust() const noexcept { return imu_trust_; }

 private:
  void updateGravity() noexcept;
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
  std::optional<HullMotion> vibration_;  ///< motion of the boom's tip at the last sample without weight; empty: unknown
  std::optional<HullMotionCovariance> vibration_covariance_;  ///< none: not requested while an IMU was in use
  Motion now_;
  std::uint64_t imu_taken_{};  ///< readings accepted up to the last newImuReading()
  /// known_: false if the IMU is rejected, or if the motion is to come from IMU or boom and is unknown. Then the weight
  /// follows from the joint angles, with the vibration of a boom whose oil is identified.
  bool known_{true}, by_imu_{};
  bool pitch_known_{}, in_degrees_{};  ///< at the last message of joints
};

}  // namespace hammer_loads
