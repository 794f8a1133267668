/// Gravity in the axes of base and hull, including every tilt of the description and of the ground.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/boom/joint_space.h"

namespace hammer_loads {

class Chain;

/// Inclination of the chain's root against the horizon (REP-103): first rolled about x, then pitched about the level y.
struct BaseTilt {
  double roll{};   ///< base_roll_rad: positive lowers the right side [rad]
  double pitch{};  ///< base_pitch_rad: positive lowers the boom's side [rad]
};

/// Returns gravity in the root's axes [m/s2], (0, 0, -g) for a level base.
Eigen::Vector3d gravityInRoot(double gravity, const BaseTilt& base) noexcept;

/// Returns gravity in the tip's axes [m/s2], including tilts fixed in the description. It is (g sin pitch, 0, -g cos
/// pitch) for a level base and joints about +y that add up to the pitch. The y component acts across the mechanism's
/// plane, where no link moves. No allocation.
Eigen::Vector3d gravityInTip(const Chain& chain, const JointVector& position, const Eigen::Vector3d& g_B) noexcept;

/// Pitch of the tip as a signed sum of joint positions, for HullPitch. It is exact where the joint axes are along the
/// tip's y.
struct PitchOfChain {
  std::vector<std::string> joints;
  std::vector<int> signs;  ///< 1 about +y of the tip, -1 about -y
  double offset{};         ///< pitch of the tip with every joint at zero [rad]
};

/// Returns the pitch by the requested joints if the chain has them all. Otherwise it uses all joints that turn about y
/// rather than across it.
PitchOfChain pitchOf(const Chain& chain, const std::vector<std::string>& asked);

}  // namespace hammer_loads
