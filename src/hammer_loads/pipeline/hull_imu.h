/// Motion of the hull from an inertial measurement unit fixed to it, and its velocity at a blow.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Velocity of the hull's origin D, in its plane.
struct TipVelocity {
  double z{};     ///< along the hull's z [m/s]
  double rate{};  ///< about its y [rad/s]
};

/// Longest time from blow to blow [s]; over a longer one the hull's mean velocity need not be zero.
constexpr double kLongestTurn = look_back::kFiveTurns;

/// The hull's motion is periodic: from blow to blow its velocity has no trend and no mean. This condition removes
/// weight, offsets and the jump at the blow from the integral of the unit's readings. The rest at both ends is the
/// velocity at the blow, mean of before and after it. None before the second blow in a row, or after a pause of the
/// unit.
///
/// Neglects: differences between revolutions, and the boom's slow motion.
class HullSpeed {
 public:
  /// Adds a reading in hull axes: force along z [m/s2], contribution of the rotation to D's velocity along z [m/s],
  /// rate about y [rad/s]. No allocation.
  void add(StampNs stamp, double force_z, double by_turning, double rate) noexcept;
  void forget() noexcept;
  void struck(StampNs blow) noexcept;
  /// Returns the velocity at the last blow.
  std::optional<TipVelocity> atBlow() const noexcept { return at_blow_; }

 private:
  struct Point {
    StampNs stamp{};
    double force{}, integral{};  ///< force minus the first force
    TipVelocity velocity;        ///< without weight and offsets
    TipVelocity way;             ///< integral of the velocity
  };
  static constexpr std::size_t kKept = 64;  ///< some 60 ms at 1 kHz: a crank sample may show a blow this late

  static Point after(const Point& point, StampNs stamp, double force, double by_turning, double rate) noexcept;
  Point at(StampNs stamp) const noexcept;
  const Point& back(std::size_t steps) const noexcept { return points_[(count_ - 1 - steps) % kKept]; }

  std::array<Point, kKept> points_;
  std::uint64_t count_{};
  double first_force_{};
  std::optional<Point> last_blow_;
  std::optional<TipVelocity> at_blow_;
};

/// One reading, in the unit's own axes.
struct ImuReading {
  Eigen::Vector3d specific_force;  ///< acceleration minus gravity [m/s2]: upright at rest (0, 0, 9.8)
  Eigen::Vector3d rate;            ///< turning rate [rad/s]
};

struct StampedImuReading {
  StampNs stamp{};
  ImuReading reading;
};

/// Reasons for which a reading is refused.
enum class ImuRefusal : std::size_t { kNotFinite, kImplausible, kOutOfOrder, kJump, kCount };

constexpr std::array<const char*, static_cast<std::size_t>(ImuRefusal::kCount)> kImuRefusalNames{
    "not finite", "implausible", "out of order", "jumps"};

/// Converts readings to the hull's motion at D, which includes weight and tilt. The angular acceleration is the
/// difference of the last two rates that did not arrive together. It is half an interval late and has sqrt(2)/interval
/// times the rate's noise. It also transfers the specific force from the unit to D, so that mounting the unit near D
/// keeps that noise out of the wrench (model.md 3).
class HullImu {
 public:
  explicit HullImu(const HullImuSettings& settings) : settings_(settings) {}

  /// Takes a reading or returns the reason against it. A reading older than the last restarts if a second older one
  /// follows, as when a log is replayed. A reading far off the others is refused (JumpGuard). No allocation.
  std::optional<ImuRefusal> update(StampNs stamp, const ImuReading& reading) noexcept;

  /// Notes a blow at an instant, where accelerations jump. No interpolation and no difference extends across it.
  void struck(StampNs stamp) noexcept;
  /// Returns the velocity of D at the last blow; empty where it is not known.
  std::optional<TipVelocity> speedAtBlow() const noexcept { return speed_.atBlow(); }

  /// Returns the reading at a stamp, in axes of hammer_hull. It lies on the line through the last two readings,
  /// extended by at most one interval. If a blow lies between, it is the nearest reading on the stamp's side. Empty
  /// before the second successive reading or when the last is more than max_age away.
  std::optional<ImuReading> reading(StampNs stamp) const noexcept;
  /// Returns the motion at a stamp, known as reading() is. Angular acceleration: zero until two readings after a blow.
  std::optional<HullMotion> at(StampNs stamp) const noexcept;

  /// Returns the time since a second reading after the last one was due [s]; negative if it is not due yet.
  double overdue(StampNs stamp) const noexcept {
    return hammer_loads::overdue(seconds(stamp - now_.stamp), std::max(0.0, seconds(now_.stamp - before_.stamp)));
  }
  /// Returns the last accepted reading, in axes of hammer_hull.
  StampedImuReading newest() const noexcept { return {now_.stamp, {now_.force, now_.rate}}; }

 private:
  bool blowBetween(StampNs from, StampNs to) const noexcept { return blow_ && from < *blow_ && *blow_ <= to; }

  // Many times the jumps of a hull on its boom at a blow, 30 m/s2 and 0.1 rad/s, to allow for vibrating steel.
  static constexpr double kLeastForceJump = 200.0;  // [m/s2]
  static constexpr double kLeastRateJump = 3.0;     // [rad/s]
  // Limit: kLeastForceJump, kLeastRateJump

  /// In axes of hammer_hull.
  struct Sample {
    StampNs stamp{};
    Eigen::Vector3d force, rate;
  };

  HullImuSettings settings_;
  Sample now_, before_;
  HullSpeed speed_;
  JumpGuard force_guard_{kLeastForceJump}, rate_guard_{kLeastRateJump};
  int readings_{};  ///< in a row, counted up to 2
  std::optional<StampNs> rewound_, blow_;
};

/// Queue of readings in order of arrival. Beyond 64 the oldest is dropped. No allocation.
class WaitingReadings {
 public:
  void add(const StampedImuReading& reading) noexcept {
    if (count_ == kMost) drop(1);
    readings_[count_++] = reading;
  }
  /// Calls each(reading) for the first ones up to a stamp and removes them.
  template <typename Each>
  void takeUpTo(StampNs stamp, const Each& each) noexcept {
    std::size_t taken = 0;
    while (taken < count_ && readings_[taken].stamp <= stamp) each(readings_[taken++]);
    if (taken > 0) drop(taken);
  }
  /// Returns the number of readings up to a stamp. Readings that wait for a bus may be later.
  std::ptrdiff_t upTo(StampNs stamp) const noexcept {
    return std::count_if(readings_.begin(), readings_.begin() + static_cast<std::ptrdiff_t>(count_),
                         [stamp](const StampedImuReading& reading) { return reading.stamp <= stamp; });
  }

 private:
  static constexpr std::size_t kMost = 64;

  void drop(std::size_t first) noexcept {
    std::move(readings_.begin() + static_cast<std::ptrdiff_t>(first),
              readings_.begin() + static_cast<std::ptrdiff_t>(count_), readings_.begin());
    count_ -= first;
  }

  std::array<StampedImuReading, kMost> readings_;
  std::size_t count_{};
};

}  // namespace hammer_loads
