/// Stiffness of the boom's oil and vibration of the boom, as its sensors show them.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/pipeline/boom_follower.h"

namespace hammer_loads {

/// Figures that change when air enters a cylinder, pins wear or a link cracks. Every blow is a known impulse, so that a
/// working hammer tests its boom five times a second.
struct BoomHealth {
  /// Index as in Boom::cylinders(). The ratio does not depend on the pose but for what the boom file has wrong of
  /// masses and places, which is the same from day to day.
  struct OfCylinder {
    double joint_angle{};             ///< angle of the cylinder's joint [rad]
    double stiffness{}, deviation{};  ///< oil stiffness over that of the boom file, and its standard deviation [-]
  };
  struct OfMode {
    double frequency{}, deviation{};  ///< standard [Hz]
    double damping{}, damping_std{};  ///< ratio; standard [-]
  };
  std::array<OfCylinder, kMaxJoints> cylinder;
  std::array<OfMode, kMaxJoints> mode;
  int count{};          ///< number of cylinders and of modes
  bool oil_explains{};  ///< false: a damping is none of oil, and what is stiff or soft beside it is uncertain
};

/// The mode whose damping is farthest from the boom file's, where that is more than the identifier expects: no oil
/// makes it. -1: none.
int modeOfOddDamping(const Boom& boom) noexcept;

/// Nothing where sensors do not show it: before its frequencies are known with their delay, while the hull bounces on
/// rock as no oil makes it, at a zero moment arm, with joints that are not known.
std::optional<BoomHealth> boomHealth(const BoomFollower& follower) noexcept;

}  // namespace hammer_loads
