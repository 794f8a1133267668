/// Turns from blow to blow: their blows and their pulses.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/pipeline/crank_step.h"
#include "hammer_loads/pipeline/elastic_follower.h"
#include "hammer_loads/pipeline/pending_blow.h"
#include "hammer_loads/pipeline/rod_ring.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/pipeline/turn_recorder.h"
#include "hammer_loads/pipeline/unmeasured_hull.h"

namespace hammer_loads {

class TurnFollower {
 public:
  /// Refers to them, which must outlive it. prior: of the hull's motion; null: the hull is held.
  TurnFollower(const HullModel& model, const WrenchColumns& columns, const CrankStep& step, const CrankFilter& tracker,
               const RodRing& rod, const ElasticFollower& elastic, const UnmeasuredHull* prior)
      : model_(&model),
        columns_(&columns),
        step_(&step),
        tracker_(&tracker),
        rod_(&rod),
        elastic_(&elastic),
        prior_(prior) {}

  /// Time begins with this stamp.
  void begin(StampNs stamp) noexcept { epoch_ = stamp; }
  /// Begins a turn that is not whole, as earlier samples do not belong to it.
  void restart() noexcept;
  /// Discards the present turn and the blow that is being measured.
  void discard() noexcept;
  /// Ends the measurement of the pending blow, which becomes one of the `ends`.
  void finishBlow(SampleResult& result) noexcept;
  /// Follows the step up to the sample of `result`. Turns whose blow is measured by now are its `ends`: some 50 ms
  /// after the blow, with its stamp. hull: motion over the step.
  void follow(const HullMotion& hull, SampleResult& result) noexcept;

  /// Notes that the last sample's loads were withheld.
  void withheld() noexcept {
    run_up_ = false;
    peak_.withheld = std::max(peak_.withheld, std::exchange(peak_.of_step, 0.0));
    if (pending_.isWaiting()) pending_.count(false);
  }
  /// Takes a published result.
  void published(const SampleResult& result) noexcept {
    run_up_ = true;
    peak_.published = std::max(peak_.published, std::exchange(peak_.of_step, 0.0));
    if (pending_.isWaiting()) pending_.count(true);
    trackErrors(result);
  }
  bool blowWaits() const noexcept { return pending_.isWaiting(); }  ///< one is still being measured
  /// Velocity of the hull at that blow; until it is given, the prior of the hull's motion counts.
  void hullMovedAtBlow(const TipVelocity& hull) noexcept;

  double peakForce() const noexcept {
    return peak_force_;
  }  ///< peak force of the last whole revolution's strike [N], 0 before it
  std::uint64_t blows() const noexcept { return turns_ - impossible_; }   ///< since the start
  std::uint64_t impossibleBlows() const noexcept { return impossible_; }  ///< RockerBlow::impossible, not among them
  std::uint64_t blankFirings() const noexcept { return blank_; }  ///< passages onto the mirrored branch, without a tool
  std::uint64_t backwardPasses() const noexcept {
    return backward_;
  }  ///< number of backward passages of the blow, less those forward again

 private:
  void doubtImpossible(CrankBlow crank, bool early, TurnEnd& end) const noexcept;
  void takeUpLater(const CrankBlow& crank, LinkMomentum& after, RockerBlow& blow) const noexcept;
  void doubtHull(const HullMotionCovariance& hull, CrankBlow& crank) const noexcept;
  void countHullSpeed(TurnEnd& end) const noexcept;
  void countBackward(const CrankStep::Passage& passage) noexcept;
  double partOfStep(bool rings) const noexcept;
  void recordTo(double from, double to) noexcept;
  void endTurn(const CrankStep::Passage& passage) noexcept;
  void endPulse(const TurnInstant& at, const CrankEstimate& before, const CrankUncertainty& doubt,
                const Eigen::Matrix3d& by_readings, TurnEnd& end) noexcept;
  void trackErrors(const SampleResult& result) noexcept;
  TurnInstant instant(double time, const CrankEstimate& crank) const noexcept;
  TurnInstant ringing(double origin, double time) const noexcept;

  const HullModel* model_;
  const WrenchColumns* columns_;
  const CrankStep* step_;
  const CrankFilter* tracker_;
  const RodRing* rod_;
  const ElasticFollower* elastic_;
  const UnmeasuredHull* prior_;
  TurnRecorder turn_;
  TurnErrors errors_;
  PendingBlow pending_;
  TurnEnd pending_end_;  ///< end of the revolution by the pending blow
  HullMotion hull_;
  StampNs epoch_{};                   ///< first sample since the last restart by time
  std::optional<StampNs> last_blow_;  ///< stamp of the last blow, if the revolution since then was seen whole
  std::uint64_t turns_{}, impossible_{}, backward_{}, blank_{};
  double peak_force_{};
  bool run_up_{};  ///< the last sample's loads are published
  /// Peak of Fz over the present revolution [N]: of steps to a published sample, to a withheld one, and of the last
  /// step.
  struct Peak {
    double published{}, withheld{}, of_step{};
    double of_strike{}, of_ring{};  ///< peak at points without and with vibration of the rod
  };
  Peak peak_;
};

}  // namespace hammer_loads
