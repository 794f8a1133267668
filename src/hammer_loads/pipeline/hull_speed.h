/// Speed of the hull when the rocker strikes, from its IMU.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/pipeline/tip_velocity.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// From blow to blow [s]: over a longer one the hull's velocity has a mean.
constexpr double kLongestTurn = look_back::kFiveTurns;

/// The hull's motion is periodic: from blow to blow its velocity has no trend and no mean. This condition removes
/// weight, offsets and the jump at the blow from the integral of the unit's readings. The rest at both ends is the
/// velocity at the blow, mean of before and after it. None before the second blow in a row, or after a pause of the
/// unit.
///
/// Neglects: differences between revolutions, and the boom's slow motion.
class HullSpeed {
 public:
  /// The unit at a stamp, axes of the hull: force along z [m/s2], what turning adds to D's velocity along z [m/s], rate
  /// about y [rad/s]. No allocation.
  void add(StampNs stamp, double force_z, double by_turning, double rate) noexcept;
  void forget() noexcept;
  void struck(StampNs blow) noexcept;
  /// At the last blow.
  std::optional<TipVelocity> atBlow() const noexcept { return at_blow_; }

 private:
  struct Point {
    StampNs stamp{};
    double force{}, integral{};  ///< less the first force
    TipVelocity velocity;        ///< but for weight and offsets
    TipVelocity way;             ///< integral of the velocity
  };
  static constexpr std::size_t kKept = 64;  ///< some 60 ms at 1 kHz: so late a crank sample may show a blow

  static Point after(const Point& point, StampNs stamp, double force, double by_turning, double rate) noexcept;
  Point at(StampNs stamp) const noexcept;
  const Point& back(std::size_t steps) const noexcept { return points_[(count_ - 1 - steps) % kKept]; }

  std::array<Point, kKept> points_;
  std::uint64_t count_{};
  double first_force_{};
  std::optional<Point> last_blow_;
  std::optional<TipVelocity> at_blow_;
};

}  // namespace hammer_loads
