/// Processing of crank samples: gate, units, filter, and the step since the sample before.
#pragma once

#include <memory>
#include <optional>

#include "hammer_loads/crank/controller_task.h"
#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/stamp_sequence.h"
#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/pipeline/crank_sample_gate.h"
#include "hammer_loads/pipeline/crank_step.h"
#include "hammer_loads/pipeline/unit_check.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

class CrankFollower {
 public:
  /// Refers to the model, which must outlive it.
  CrankFollower(const HullModel& model, const PipelineSettings& settings);
  CrankFollower(const CrankFollower&) = delete;
  CrankFollower& operator=(const CrankFollower&) = delete;

  /// Outcome of a sample.
  enum class Taken {
    kRefused,    ///< not accepted: refusal() has the reason
    kBegan,      ///< accepted as the first one after a start, a gap or a jump back in time
    kRevised,    ///< accepted; the decision whether the last passage was a blow is revised
    kRestarted,  ///< accepted; it contradicts the samples before, which are discarded
    kContinued,  ///< accepted; step() is the time since the sample before
  };

  /// Judges a sample by itself: header stamp and reading. Only if there is no refusal, take() must follow.
  std::optional<Refusal> judge(StampNs header, const CrankSample& measured) noexcept;
  /// Instant of the judged sample: its header stamp less crank_latency_s, or that refitted by sequence.
  StampNs stamp() const noexcept { return stamp_; }
  /// Takes the judged sample. hull: motion at it.
  Taken take(const HullMotion& hull) noexcept;
  /// Ends a step: later steps begin at this sample.
  void accept() noexcept;

  /// CrankFilter::moveZero().
  void moveZero(double angle) noexcept { tracker_->moveZero(angle); }
  /// CrankFilter::doubtZero().
  void doubtZero(bool doubted) noexcept { tracker_->doubtZero(doubted); }
  double reading() const noexcept { return measured_.angle; }  ///< angle of the judged sample [rad]
  /// Returns true if angle or speed may be in another unit that is not recognised yet.
  bool suspectsUnit() const noexcept { return unit_check_.suspects(); }
  /// Returns true if the estimate may be published. peak_force: of the last whole revolution [N], 0 before it.
  bool isSettled(const HullMotion& hull, double peak_force) noexcept;

  const CrankEstimate& estimate() const noexcept { return estimate_; }
  /// Passes the displacement of the crank by an elastic rod to the filter, see CrankFilter::considerRod().
  void considerRod(const CrankAngle& angle, double speed) noexcept;
  /// Updates the hull's motion at the accepted sample; the crank's acceleration is computed with it.
  void hullMoved(const HullMotion& hull) noexcept;
  const CrankStep& step() const noexcept { return step_; }
  const CrankFilter& tracker() const noexcept { return *tracker_; }
  const StampSequence& stamps() const noexcept { return sequence_; }
  const ControllerTask& task() const noexcept { return task_; }
  CrankUnit unit() const noexcept { return unit_check_.unit(); }
  /// Stamp of the sample at which the encoder slipped last [ns]; none if it did not.
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
