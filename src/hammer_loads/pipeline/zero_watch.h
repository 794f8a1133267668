/// Check whether the encoder's zero is so far off that nothing may be published, and where it is.
#pragma once

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/zero_search.h"

namespace hammer_loads {

/// Compares two judges of the zero once a turn: ZeroSearch sees the whole turn within some 2 deg; the filter's own
/// estimate is good to 0.3 deg, but only of small errors. Where either of them shows an error that matters, the
/// filter's zero is moved there and refined until the filter agrees. Nothing is published meanwhile, nor of a zero that
/// is off by more than kMost: the parameter has to be set right.
///
/// A small negative error is left to the deviations: an elastic connecting rod looks like one of up to 1.6 deg. Where
/// its pins rub the search shows more, which the filter refines to that: it is taken back.
class ZeroWatch {
 public:
  static constexpr double kMost = 2.0 * kDegree;  ///< larger errors are not published [rad]

  ZeroWatch(const ShaftModel& model, double drive_inertia) noexcept : search_(model, drive_inertia) {}

  /// After each sample that the filter has taken. step: since the sample before [s], 0 if it is not known; hull: its
  /// motion. Returns by how much the filter's zero is to be moved [rad], mostly 0.
  double follow(const CrankFilter& filter, double reading, double step, const HullMotion& hull) noexcept;

  bool withholds() const noexcept { return isOff() && (!settled_ || std::abs(moved_) > kMost); }
  /// The zero in force is another one than the parameter's.
  bool isOff() const noexcept { return std::abs(moved_) > kNone; }
  /// The filter's estimate of the zero may be wrong: readings and model do not agree, nor does the search with it.
  bool doubts(const CrankFilter& filter) const noexcept;
  struct Stated {
    double error{};      ///< error of the parameter [rad of the crank's angle]
    double deviation{};  ///< standard [rad]
  };
  /// Error of the parameter as far as it is known by now: by the filter where the search does not contradict it.
  Stated stated(const CrankFilter& filter) const noexcept;
  /// The zero in force is known well enough for what cannot be taken back: load cycles.
  bool mayCount(const CrankFilter& filter) const noexcept;
  bool isSettled() const noexcept { return settled_; }  ///< the filter agrees with the zero that was found
  /// By how much the zero in force is larger than the parameter's [rad of the crank's angle].
  double moved() const noexcept { return moved_; }

 private:
  static constexpr double kNone = 0.3 * kDegree;      ///< an error that was there and is gone leaves less
  static constexpr double kRodLooks = 1.6 * kDegree;  ///< largest apparent error of a correct zero, negative

  double move(double angle, double deviation) noexcept;
  static bool agrees(const CrankFilter& filter) noexcept;
  double toMove(const CrankFilter& filter) noexcept;

  ZeroSearch search_;
  int evaluations_{}, slips_{};
  double moved_{}, deviation_{};  ///< by how much the zero was moved, and its standard deviation then [rad]
  bool settled_{};
  bool left_{};  ///< a negative error found by the search is friction in the pins
};

}  // namespace hammer_loads
