/// The blow: what the rocker gives to the tool and to its support within no time.
#pragma once

#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// Angular speeds are psi' (positive about hull +y); axes of hammer_hull.
struct RockerBlow {
  double rocker_speed_before{};  ///< [rad/s], < 0 for a real blow
  double rocker_speed_after{};   ///< [rad/s]
  double restitution{};          ///< R = -after/before [-]
  double energy{};               ///< given to the tool [J]
  double tool_impulse_x{};       ///< BY the tool ON the rocker [N s]
  double tool_impulse_z{};       ///< BY the tool ON the rocker [N s], > 0 for a real blow
  double support_impulse_x{};    ///< BY the rocker ON the hull at D [N s]
  double support_impulse_z{};    ///< BY the rocker ON the hull at D [N s]
};

/// Blow of a crank that passes the blow forward at a speed w > 0 [rad/s]: the crank keeps its speed, the rocker's jumps
/// from u(2 pi -) w to u(0 +) w (model.md 1). P1 (4)-(9) with frictionless face and massless rod.
RockerBlow blowAtCrankSpeed(const Mechanism& mechanism, double crank_speed) noexcept;

}  // namespace hammer_loads
