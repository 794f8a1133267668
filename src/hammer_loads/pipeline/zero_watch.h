/// Check whether the encoder's zero is so far off that nothing may be published, and where it is.
#pragma once

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/zero_search.h"

namespace hammer_loads {

/// Compares two estimates of the zero once per revolution. ZeroSearch covers the whole revolution with an error of some
/// 2 deg. The filter's estimate is accurate to 0.3 deg, but only for small errors. If either shows a significant error,
/// the filter's zero is moved there and refined until the filter agrees. Nothing is published meanwhile, nor for an
/// error beyond kMost, where the parameter has to be corrected.
///
/// A small negative error stays within two standard deviations, since an elastic connecting rod causes an apparent one
/// of up to 1.6 deg. With friction in the pins the search shows a larger error, which the filter refines to the former.
/// The move is then undone.
class ZeroWatch {
 public:
  static constexpr double kMost = 2.0 * kDegree;  ///< larger errors are not published [rad]

  ZeroWatch(const ShaftModel& model, double drive_inertia) noexcept : search_(model, drive_inertia) {}

  /// Follows each sample that the filter has accepted. step: since the previous sample [s], 0 if unknown; hull: its
  /// motion; rod_explains: an elastic rod explains the last blows. Returns the angle by which the filter's zero is to
  /// be moved [rad], mostly 0.
  double follow(const CrankFilter& filter, bool rod_explains, double reading, double step,
                const HullMotion& hull) noexcept;

  bool withholds() const noexcept { return isOff() && (!settled_ || std::abs(moved_) > kMost); }
  /// Returns true if the zero in use differs from the parameter's.
  bool isOff() const noexcept { return std::abs(moved_) > kNone; }
  /// Returns true if the filter's estimate of the zero may be wrong, as it contradicts the readings or the search.
  bool contradicts(const CrankFilter& filter) const noexcept;
  struct Stated {
    double error{};      ///< error of the parameter [rad of the crank's angle]
    double deviation{};  ///< standard deviation [rad]
  };
  /// Returns the best estimate of the parameter's error: that of the filter unless the search contradicts it.
  Stated stated(const CrankFilter& filter) const noexcept;
  /// Returns true if the zero in use is known well enough to count load cycles, which cannot be corrected later.
  bool mayCount(const CrankFilter& filter) const noexcept;
  bool isSettled() const noexcept { return settled_; }  ///< the filter agrees with the zero that was found
  /// Returns the zero in use minus that of the parameter [rad of the crank's angle].
  double moved() const noexcept { return moved_; }

 private:
  static constexpr double kNone = 0.3 * kDegree;      ///< a corrected error leaves less
  static constexpr double kRodLooks = 1.6 * kDegree;  ///< largest apparent error of a correct zero, negative

  double move(double angle, double deviation) noexcept;
  static bool agrees(const CrankFilter& filter) noexcept;
  double toMove(const CrankFilter& filter, bool rod_explains) noexcept;

  ZeroSearch search_;
  int evaluations_{}, slips_{};
  double moved_{}, deviation_{};  ///< total move of the zero, and its standard deviation then [rad]
  bool settled_{};
  bool left_{};  ///< a negative error found by the search is friction in the pins
};

}  // namespace hammer_loads
