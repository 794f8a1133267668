/// Motion of the mechanism's frame: weight and the hull's own motion.
#pragma once

namespace hammer_loads {

struct HullMotion;

/// Gravity in hull axes [m/s2]: (g sin pitch, 0, -g cos pitch) for a level base.
struct Gravity {
  double x{};
  double z{};

  operator HullMotion() const noexcept;  ///< motion of a hull at rest
};

/// Motion of the frame hammer_hull at its origin D, in its plane. An acceleration of D acts on everything in the hull
/// as gravity in the opposite direction. Both are therefore one quantity: the negative reading of an accelerometer at
/// D.
struct HullMotion {
  Gravity gravity;        ///< effective: gravity less the acceleration of D, hull axes [m/s2]
  double rate{};          ///< Omega, turning rate about +y [rad/s]
  double acceleration{};  ///< angular acceleration about +y [rad/s2]

  bool turns() const noexcept { return rate != 0.0 || acceleration != 0.0; }
};

/// Motion on the line from a (part 0) to b (part 1); of equal motions that motion to the bit.
inline HullMotion blend(const HullMotion& a, const HullMotion& b, double part) noexcept {
  return {{a.gravity.x + part * (b.gravity.x - a.gravity.x), a.gravity.z + part * (b.gravity.z - a.gravity.z)},
          a.rate + part * (b.rate - a.rate),
          a.acceleration + part * (b.acceleration - a.acceleration)};
}

inline Gravity::operator HullMotion() const noexcept { return {*this, 0.0, 0.0}; }

}  // namespace hammer_loads
