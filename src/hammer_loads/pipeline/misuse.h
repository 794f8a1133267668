/// Misuse that wears a hammer without breaking rock, counted from measurements.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>

namespace hammer_loads {

/// Counters since the start. Misuse is counted only where it is measured: `judged_blows` and `placed_time` are the
/// number of blows and the time that were judged; zero means unknown.
struct MisuseCounts {
  double work_time{};             ///< over accepted samples, gaps left out [s]
  std::uint64_t blank_firings{};  ///< the rocker passed without meeting the tool
  std::uint64_t judged_blows{};   ///< at which cylinder pressures show the rock's force on the hull
  /// Number of judged blows at which the hold-down force had not exceeded its error since the previous blow. The blow
  /// falls on the hull's retainer, or the hold-down force is too small to bring the hull back after its recoil; in the
  /// pressures both look alike.
  std::uint64_t blows_without_hold_down{};
  double placed_time{};  ///< duration of whole revolutions at which the boom's joints show the place of the hull [s]
  double still_time{};   ///< part of placed_time for which the hull had not moved for MisuseFollower::kPatience of
                         ///< hammering or more [s]

  void add(const MisuseCounts& other) noexcept {
    work_time += other.work_time;
    blank_firings += other.blank_firings;
    judged_blows += other.judged_blows;
    blows_without_hold_down += other.blows_without_hold_down;
    placed_time += other.placed_time;
    still_time += other.still_time;
  }
  std::optional<std::uint64_t> withoutHoldDown() const noexcept {
    return judged_blows > 0 ? std::make_optional(blows_without_hold_down) : std::nullopt;
  }
  std::optional<double> still() const noexcept {
    return placed_time > 0.0 ? std::make_optional(still_time) : std::nullopt;
  }
};

/// Hammering without penetration: the hull follows a tool that penetrates; if it does not move, the work becomes heat
/// and noise.
class MisuseFollower {
 public:
  /// Makers of breakers allow 15 to 20 s at one place (Stanley MB05, operation: "15 - 20 seconds. If breakout does not
  /// occur within this time, move").
  static constexpr double kPatience = 15.0;  // [s]
  /// Least displacement of a moved hull: two standard deviations of a tip 6 m away with joint sensors of 0.1 deg.
  static constexpr double kMoved = 0.02;  // [m]
  // Warning: kPatience, kMoved

  /// Takes the position of the hull's origin at a sample [m], in any fixed frame.
  void hullAt(const Eigen::Vector3d& place) noexcept {
    if (place_ && (place - *place_).norm() <= kMoved) return;
    place_ = place;
    at_place_ = 0.0;
  }
  /// Notes that the joints do not determine the hull's place.
  void hullLost() noexcept { place_.reset(); }
  /// Takes whether the rock bears on the hull at a sample; empty where pressures do not show it. A hull leaves the rock
  /// at each recoil, which is no misuse as long as it comes back.
  void pressed(std::optional<bool> now) noexcept {
    unknown_ = unknown_ || !now;
    pressed_ = pressed_ || now.value_or(false);
    watched_ = true;
  }
  /// Ends a revolution with a blow. period: its length [s], empty if it was not observed completely. Returns true if
  /// the rock bore on the hull in it; empty: not known.
  std::optional<bool> blow(std::optional<double> period) noexcept {
    std::optional<bool> pressed;
    if (period && watched_ && !unknown_) {
      pressed = pressed_;
      ++counts_.judged_blows;
      counts_.blows_without_hold_down += !pressed_;
    }
    watched_ = unknown_ = pressed_ = false;
    if (!period || !place_) return pressed;
    at_place_ += *period;
    counts_.placed_time += *period;
    counts_.still_time += std::fmin(*period, std::fmax(0.0, at_place_ - kPatience));
    return pressed;
  }

  const MisuseCounts& counts() const noexcept { return counts_; }

 private:
  MisuseCounts counts_;
  std::optional<Eigen::Vector3d> place_;
  double at_place_{};                       ///< hammering since the hull came here [s]
  bool watched_{}, unknown_{}, pressed_{};  ///< since the last blow: any sample judged, any unknown, any pressed
};

}  // namespace hammer_loads
