/// The crank's path over the step between the last two samples, and its passages of the blow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

constexpr double kPulseStep = 1.25e-3;  ///< [s] between points of a path at most: 15 of them in the MO-100's pulse
// Numerical: kPulseStep
constexpr double kBesideBlow = 1e-7;  ///< [s] before and after the blow where its two sides are looked at
// Numerical: kBesideBlow

/// The part of an estimate that determines a load.
inline CrankMotion motionOf(const CrankEstimate& crank) noexcept {
  return {crank.position.angle, crank.speed, crank.acceleration};
}

/// Refers to the filter, whose last update it belongs to. Times are after the step's start [s].
class CrankStep {
 public:
  /// The blow passed forward or backward, whether or not anything strikes.
  struct Passage {
    double time{};
    std::int64_t blow{};  ///< index as in CrankPosition
    bool forward{};
    double speed_before{};  ///< crank speed before the passage, in the order of time [rad/s]
    double speed_after{};   ///< crank speed after the passage [rad/s]
    bool smooth{};          ///< onto the mirrored branch or back from it, without a jump
    bool may_strike{};      ///< true if it strikes, or leads onto the mirrored branch, which may turn out wrong
    bool strikes{};         ///< forward, for the first time, and not creeping: the rocker hits the tool
  };

  CrankStep(const CrankFilter& tracker, const HullModel& model) : tracker_(&tracker), model_(&model) {}

  /// The time before the last sample, in position `at`, is not known.
  void forget(const CrankPosition& at) noexcept;
  /// A step of `length` [s] that began at stamp `start` in position `from`; finds its passages.
  void take(StampNs start, double length, const CrankPosition& from) noexcept;

  bool known() const noexcept { return known_; }
  StampNs start() const noexcept { return start_; }
  double length() const noexcept { return length_; }
  /// Stamp of an instant this long after the start [s].
  StampNs stampAt(double time) const noexcept {
    return start_ + static_cast<StampNs>(std::llround(time / kSecondsPerNs));
  }
  CrankEstimate at(double time) const noexcept { return tracker_->between(time); }
  /// At its end.
  const LinksAtAngle& links() const noexcept { return links_; }
  /// Motion of the links at an angle; at the step's ends it is known already.
  LinkMotion linksAt(CrankAngle angle) const noexcept {
    if (angle == links_.angle) return links_.links;
    return angle == links_before_.angle ? links_before_.links : hammer_loads::linksAt(*model_, angle).links;
  }
  double driveInertia() const noexcept { return tracker_->driveInertia(); }  ///< at its end [kg m2]
  /// In order of time; of more than the array holds (some 30 turns a step) the last are left out.
  const Passage* begin() const noexcept { return passage_.data(); }
  const Passage* end() const noexcept { return passage_.data() + passages_; }
  /// The rocker hits the tool within it.
  bool strikes() const noexcept {
    return std::any_of(begin(), end(), [](const Passage& passage) { return passage.strikes; });
  }

  /// Estimate on one side of a passage that is not smooth: exactly at the blow, so that nothing is lost to rounding
  /// there.
  CrankEstimate besides(const Passage& passage, Side side) const noexcept;
  /// Standard deviation of the instant of a passage [s].
  double timeDeviation(const Passage& passage) const noexcept;
  /// Crank at(time), or besides(passage, side), as each of the samples at the step's ends predicts it; none where one
  /// of them does not reach that far.
  std::optional<CrankWays> ways(double time) const noexcept { return tracker_->waysBetween(time); }
  std::optional<CrankWays> waysBesides(const Passage& passage, Side side) const noexcept;

 private:
  Passage passageOf(std::int64_t blow, bool forward) const noexcept;
  double timeOfBlow(std::int64_t blow) const noexcept;
  double timeBesides(const Passage& passage, Side side) const noexcept;

  const CrankFilter* tracker_;
  const HullModel* model_;
  LinksAtAngle links_before_, links_;  ///< at both ends
  bool known_{};
  StampNs start_{};
  double length_{};
  std::int64_t furthest_blow_{};  ///< highest index of a blow passed forward since the restart
  std::size_t passages_{};
  std::array<Passage, 32> passage_;
};

}  // namespace hammer_loads
