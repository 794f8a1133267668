/// Processing of crank samples: checks, filter, and the step since the sample before with its passages of the blow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/stamp_sequence.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

constexpr double kPulseStep = 1.25e-3;  ///< [s] between points of a path at most: 15 of them in the MO-100's pulse
// Numerical: kPulseStep
constexpr double kBlowMargin = 1e-7;  ///< [s] before and after the blow where its two sides are looked at
// Numerical: kBlowMargin

/// Returns the part of an estimate that determines a load.
inline CrankMotion motionOf(const CrankEstimate& crank) noexcept {
  return {crank.position.angle, crank.speed, crank.acceleration};
}

/// Step between samples, for the filter's last update. Refers to the filter; times count from the step's start [s].
class CrankStep {
 public:
  /// The blow passed forward or backward, whether or not anything strikes.
  struct Passage {
    double time{};
    std::int64_t blow{};  ///< index as in CrankPosition
    bool forward{};
    double speed_before{};  ///< crank speed before the passage, in the order of time [rad/s]
    double speed_after{};   ///< crank speed after the passage [rad/s]
    bool smooth{};          ///< leads onto the mirrored branch or back from it, without a jump
    bool may_strike{};      ///< true if it strikes, or leads onto the mirrored branch, which may turn out wrong
    bool strikes{};         ///< forward, for the first time, and not creeping: the rocker hits the tool
  };

  CrankStep(const CrankFilter& tracker, const HullModel& model) : tracker_(&tracker), model_(&model) {}

  /// Discards the time before the last sample, which is in position `at`.
  void forget(const CrankPosition& at) noexcept;
  /// Sets a step of `length` [s] that began at stamp `start` in position `from`, and finds its passages.
  void set(StampNs start, double length, const CrankPosition& from) noexcept;

  bool known() const noexcept { return known_; }
  StampNs start() const noexcept { return start_; }
  double length() const noexcept { return length_; }
  /// Returns the stamp of an instant `time` [s] after the start.
  StampNs stampAt(double time) const noexcept {
    return start_ + static_cast<StampNs>(std::llround(time / kSecondsPerNs));
  }
  CrankEstimate at(double time) const noexcept { return tracker_->between(time); }
  /// Returns the links at the step's end.
  const LinksAtAngle& links() const noexcept { return links_; }
  /// Returns the motion of the links at an angle. At the step's ends it is known already.
  LinkMotion linksAt(CrankAngle angle) const noexcept {
    if (angle == links_.angle) return links_.links;
    return angle == links_before_.angle ? links_before_.links : hammer_loads::linksAt(*model_, angle).links;
  }
  double driveInertia() const noexcept { return tracker_->driveInertia(); }  ///< at its end [kg m2]
  /// Passages in order of time. Beyond what the array holds (some 30 revolutions per step) the last are left out.
  const Passage* begin() const noexcept { return passage_.data(); }
  const Passage* end() const noexcept { return passage_.data() + passages_; }
  /// Returns true if the rocker hits the tool within the step.
  bool strikes() const noexcept {
    return std::any_of(begin(), end(), [](const Passage& passage) { return passage.strikes; });
  }

  /// Returns the estimate on one side of a passage that is not smooth. It is exactly at the blow, so that nothing is
  /// lost to rounding.
  CrankEstimate atSide(const Passage& passage, Side side) const noexcept;
  /// Standard deviation of the instant of a passage [s].
  double timeDeviation(const Passage& passage) const noexcept;
  /// Returns at(time), or atSide(passage, side), as each of the samples at the step's ends predicts it. Empty where one
  /// of them does not reach that far.
  std::optional<CrankPaths> paths(double time) const noexcept { return tracker_->pathsBetween(time); }
  std::optional<CrankPaths> pathsAtSide(const Passage& passage, Side side) const noexcept;

 private:
  Passage passageOf(std::int64_t blow, bool forward) const noexcept;
  double timeOfBlow(std::int64_t blow) const noexcept;
  double timeAtSide(const Passage& passage, Side side) const noexcept;

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

class CrankFollower {
 public:
  /// Refers to the model, which must outlive it.
  CrankFollower(const HullModel& model, const PipelineSettings& settings);
  CrankFollower(const CrankFollower&) = delete;
  CrankFollower& operator=(const CrankFollower&) = delete;

  /// Outcome of a sample.
  enum class Outcome {
    kRefused,    ///< not accepted: refusal() has the reason
    kBegan,      ///< accepted as the first one after a start, a gap or a jump back in time
    kRevised,    ///< accepted; the decision whether the last passage was a blow is revised
    kRestarted,  ///< accepted; it contradicts the samples before, which are discarded
    kContinued,  ///< accepted; step() is the time since the sample before
  };

  /// Judges a sample by itself: header stamp and reading. Only if there is no refusal, update() must follow.
  std::optional<Refusal> judge(StampNs header, const CrankSample& measured) noexcept;
  /// Instant of the judged sample: its header stamp minus crank_latency_s, or that refitted by sequence.
  StampNs stamp() const noexcept { return stamp_; }
  /// Updates the filter with the judged sample. hull: its motion at the sample.
  Outcome update(const HullMotion& hull) noexcept;
  /// Accepts the judged sample; the next step begins at it.
  void accept() noexcept;

  /// CrankFilter::moveZero().
  void moveZero(double angle) noexcept { tracker_->moveZero(angle); }
  /// CrankFilter::setZeroContradicted().
  void setZeroContradicted(bool contradicted) noexcept { tracker_->setZeroContradicted(contradicted); }
  double reading() const noexcept { return measured_.angle; }  ///< angle of the judged sample [rad]
  /// Returns true if angle or speed may be in another unit that is not recognised yet.
  bool suspectsUnit() const noexcept { return unit_check_.suspects(); }
  /// Returns true if the estimate may be published. peak_force: of the last whole revolution [N], 0 before it.
  bool isSettled(const HullMotion& hull, double peak_force) noexcept;

  const CrankEstimate& estimate() const noexcept { return estimate_; }
  /// Passes the displacement of the crank by an elastic rod to the filter, see CrankFilter::inflateByRod().
  void inflateByRod(const CrankAngle& angle, double speed) noexcept;
  /// Updates the hull's motion at the accepted sample; the crank's acceleration is computed with it.
  void hullMoved(const HullMotion& hull) noexcept;
  const CrankStep& step() const noexcept { return step_; }
  const CrankFilter& tracker() const noexcept { return *tracker_; }
  const StampSequence& stamps() const noexcept { return sequence_; }
  const ControllerTask& task() const noexcept { return task_; }
  CrankUnit unit() const noexcept { return unit_check_.unit(); }
  /// Returns the stamp of the sample at which the encoder slipped last [ns]; empty if it did not.
  const std::optional<StampNs>& slipped() const noexcept { return slipped_; }
  bool angleIsFrozen() const noexcept { return gate_.angleIsFrozen(); }

 private:
  StampSequence::Repeats repeatsOf(const CrankSample& measured) const noexcept;
  bool passesCounts() const noexcept;
  bool turns() const noexcept;
  std::optional<Refusal> place(StampNs header, const CrankSample& measured) noexcept;
  void checkUnit(StampNs stamp, const CrankSample& measured) noexcept;
  std::optional<Refusal> otherUnit() const noexcept;
  void restart() noexcept;
  void followLostTime() noexcept;
  void followStamp() noexcept;
  double stampsOff() const noexcept;

  const HullModel* model_;
  PipelineSettings settings_;
  UnitCheck unit_check_;
  std::optional<StampNs> last_raw_stamp_;  ///< stamp of the last sample, accepted or not
  CrankSample last_raw_;                   ///< last sample, accepted or not
  StampNs latency_;                        ///< latency of the header stamps
  StampSequence sequence_;
  ControllerTask task_;
  std::unique_ptr<CrankFilter> tracker_;
  CrankSampleGate gate_;
  CrankStep step_;
  CrankEstimate estimate_;

  StampNs stamp_{};  ///< stamp of the judged sample
  CrankSample measured_;
  CrankSampleGate::Verdict verdict_;

  int slips_{};  ///< number of the encoder's slips so far
  std::optional<StampNs> slipped_;
  CrankPosition last_position_;  ///< at the last accepted sample
  bool unsettled_{};
  bool speed_measured_{};
  int samples_since_restart_{};
};

}  // namespace hammer_loads
