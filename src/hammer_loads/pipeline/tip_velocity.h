#pragma once

namespace hammer_loads {

/// Velocity of the hull's origin D, in its plane.
struct TipVelocity {
  double z{};     ///< along the hull's z [m/s]
  double rate{};  ///< about its y [rad/s]
};

}  // namespace hammer_loads
