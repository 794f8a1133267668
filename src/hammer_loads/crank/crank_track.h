/// What the filter made of a recording's samples, and what the samples after them make of it.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// A sample as the filter left it; once it is smoothed, `belief` is by the samples after it as well.
struct TrackedSample {
  Tracking tracking{};  ///< of a beginning: kRestarted
  double step{};        ///< since the last accepted sample [s]; of a beginning: 0
  double lost_time{};   ///< of the step, beyond what the stamps say [s]
  HullMotion hull;      ///< mean over the step
  CrankWalks walks;     ///< over it
  BlowPrior prior;      ///< for a blow within it
  CrankBelief belief;
  double growth{1.0};                                           ///< of variances
  ConstantErrors::Matrix root{ConstantErrors::Matrix::Zero()};  ///< of the sensor's errors
  double consistency{}, strike_consistency{};
  double resolution{};  ///< of the angle sensor [rad]
  int slips{};          ///< of it, so far
  bool has_speed{}, is_plausible{}, is_proven{}, is_doubtful{};
  bool reading_shows_side{};
  bool is_exact{};   ///< its stamp does not jitter: the encoder decides the side of a blow
  bool was_wrong{};  ///< on a branch that turned out wrong
};

/// Fixed-interval smoother behind the filter: samples come in, and go out by some seconds later ones. An interval ends
/// where the filter restarted, or took up what it did not expect; there the filter's own estimate is the result. Memory
/// is that of kWindow and kOverlap.
class CrankTrack {
 public:
  CrankTrack(const Mechanism& mechanism, Level level, double drive_inertia, const CrankFilterSettings& settings,
             const std::optional<Coupling>& coupling = {});
  CrankTrack(const CrankTrack&) = delete;
  CrankTrack& operator=(const CrankTrack&) = delete;

  /// The filter, at the last sample that came in; samples go to it by start() and update() alone.
  CrankFilter& filter() noexcept { return filter_; }
  void setHullMotion(const HullMotion& hull) noexcept;
  void start(const CrankSample& sample);
  Tracking update(double dt, const CrankSample& sample);
  /// As CrankTracker::considerRod(), of the last sample.
  void considerRod(double angle, double speed) noexcept;
  /// No more samples come in.
  void close();

  bool isClosed() const noexcept { return closed_; }
  bool isReady() const noexcept { return ready_ > 0; }  ///< a smoothed sample can be taken
  TrackedSample take();                                 ///< the earliest one, in the order of coming in

 private:
  static constexpr double kWindow = 20.0;  ///< [s] smoothed at once
  // Guard: CrankTrack.GivesEverySampleOnceAndSomeSecondsLater of kWindow
  /// [s] after it, whose samples are used: what changes slowly is known by then.
  static constexpr double kOverlap = 0.5 * kWindow;

  void add(TrackedSample sample);
  void revise() noexcept;
  void smooth(std::size_t count);
  std::optional<CrankBelief> before(const TrackedSample& sample, const TrackedSample& later,
                                    const CrankBelief& next) const noexcept;
  CrankBelief settled(const TrackedSample& sample, const CrankBelief& smoothed, double next_factor) const noexcept;

  Mechanism mechanism_;
  ShaftModel model_;  ///< with the latest motion of the hull
  HullMotion hull_;   ///< at the last accepted sample
  CrankFilter filter_;
  std::deque<TrackedSample> samples_;
  std::size_t ready_{};  ///< the first ones of samples_, smoothed
  double span_{};        ///< of those behind them [s]
  bool closed_{};
};

}  // namespace hammer_loads
