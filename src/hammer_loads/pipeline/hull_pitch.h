/// Hull pitch from boom joint states.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hammer_loads {

/// Sum of the pitch joints' latest angles, each with its sign (contract: boom + arm + hammer, all about +y), and an
/// offset. Messages may hold any subset of joints in any order.
class HullPitch {
 public:
  /// A larger angle is refused: degrees are taken and recognised, garbage is not [rad].
  static constexpr double kMostAngle = 1e4;
  // Limit: kMostAngle

  /// initial: pitch until every joint has been heard [rad].
  HullPitch(std::vector<std::string> joints, double initial) : HullPitch(std::move(joints), {}, 0.0, initial) {}
  /// signs: 1 about +y, -1 about -y, one for each joint; empty: all 1. offset: pitch where all of them are at zero
  /// [rad].
  HullPitch(std::vector<std::string> joints, std::vector<int> signs, double offset, double initial);

  /// Takes the pitch joints of a message; returns whether there was any. Angles that are not finite or beyond 1e4 rad
  /// are refused and counted.
  bool update(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;

  double pitch() const noexcept { return pitch_; }             ///< [rad]
  bool known() const noexcept { return unheard_ == 0; }        ///< every pitch joint has been heard
  std::uint64_t refused() const noexcept { return refused_; }  ///< joint angles refused
  /// Returns true if the latest angle of a joint exceeds a whole turn, which no boom reaches.
  bool looksLikeDegrees() const noexcept;
  /// Joints not heard yet, for diagnostics.
  std::vector<std::string> unheard() const;

 private:
  std::vector<std::string> joints_;
  std::vector<int> signs_;
  double offset_;
  std::vector<double> angles_;
  std::vector<bool> heard_;
  std::size_t unheard_;
  double pitch_;
  std::uint64_t refused_{};
};

}  // namespace hammer_loads
