/// Stiffness of the boom's oil and vibration of the boom, as its sensors show them.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/pipeline/boom_follower.h"

namespace hammer_loads {

/// Figures that change when air enters a cylinder, pins wear or a link cracks. Every blow is a known impulse, so that a
/// working hammer tests its boom five times a second.
struct BoomHealth {
  /// Index as in Boom::cylinders(). The ratio depends on the pose only by errors of the boom file's masses and places,
  /// which do not change from day to day.
  struct OfCylinder {
    double joint_angle{};             ///< angle of the cylinder's joint [rad]
    double stiffness{}, deviation{};  ///< oil stiffness over that of the boom file, and its standard deviation [-]
  };
  struct OfMode {
    double frequency{}, deviation{};  ///< natural frequency and its standard deviation [Hz]
    double damping{}, damping_std{};  ///< damping ratio and its standard deviation [-]
  };
  std::array<OfCylinder, kMaxJoints> cylinder;
  std::array<OfMode, kMaxJoints> mode;
  int count{};          ///< number of cylinders and of modes
  bool oil_explains{};  ///< false if a damping is not that of oil, so that the stiffnesses are uncertain
};

/// Returns the mode whose damping differs most from the boom file's; -1 if oil explains the damping of all modes.
int modeOfOddDamping(const Boom& boom) noexcept;

/// Returns the figures; empty where sensors do not determine them: before the frequencies are known with their delay,
/// while the hull bounces on rock, at a zero moment arm, or with unknown joints.
std::optional<BoomHealth> boomHealth(const BoomFollower& follower) noexcept;

}  // namespace hammer_loads
