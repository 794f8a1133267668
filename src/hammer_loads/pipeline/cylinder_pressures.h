/// Measured pressures in the chambers of the boom's cylinders at the instants of the crank samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/joint_space.h"
#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

enum class Chamber : std::size_t { kBore, kRod };

/// The last two readings of each chamber, interpolated linearly and extrapolated by at most one interval. No
/// allocation.
class CylinderPressures {
 public:
  /// max_age: largest time from an instant to the nearest reading [s].
  explicit CylinderPressures(double max_age) : max_age_(max_age) {}

  /// Takes a gauge pressure [Pa] of a cylinder. It is refused and counted if it is not finite, beyond the strength of
  /// steel, not newer than the last, or far off the others (JumpGuard). Time that runs back is accepted from the second
  /// reading on.
  bool update(StampNs stamp, std::size_t cylinder, Chamber chamber, double pressure) noexcept;
  /// Returns true if the pressures of both chambers are known.
  bool known(std::size_t cylinder, StampNs stamp) const noexcept {
    return known(tracks_[cylinder][0], stamp) && known(tracks_[cylinder][1], stamp);
  }
  /// Returns the pressures; empty unless both chambers are known.
  std::optional<ChamberPressures> at(std::size_t cylinder, StampNs stamp) const noexcept;

  /// Stamp of a cylinder's last reading.
  StampNs newest(std::size_t cylinder) const noexcept {
    return std::max(tracks_[cylinder][0].now.stamp, tracks_[cylinder][1].now.stamp);
  }
  double greatest() const noexcept { return greatest_; }  ///< largest magnitude of all accepted readings [Pa]
  std::uint64_t accepted() const noexcept { return accepted_; }
  std::uint64_t refused() const noexcept { return refused_; }
  /// Number of accepted readings of a cylinder, by which a caller recognises new ones.
  std::uint64_t count(std::size_t cylinder) const noexcept { return counts_[cylinder]; }

 private:
  static constexpr double kLeastJump = 5e6;  // [Pa]: a fifth of the working pressure
  // Limit: kLeastJump

  struct Reading {
    StampNs stamp{};
    double pressure{};
  };
  struct Track {
    Reading before, now;
    int readings{};  ///< in a row, counted up to 2
    std::optional<StampNs> rewound;
    JumpGuard guard{kLeastJump};
  };
  bool known(const Track& track, StampNs stamp) const noexcept {
    return track.readings > 0 && std::abs(seconds(stamp - track.now.stamp)) <= max_age_;
  }
  std::optional<double> at(const Track& track, StampNs stamp) const noexcept;

  double max_age_;
  std::array<std::array<Track, 2>, kMaxJoints> tracks_;
  std::array<std::uint64_t, kMaxJoints> counts_{};
  double greatest_{};
  std::uint64_t accepted_{}, refused_{};
};

}  // namespace hammer_loads
