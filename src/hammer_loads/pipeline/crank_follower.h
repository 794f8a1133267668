/// From crank samples to the crank's motion: gate, units, filter, the step since the sample before.
#pragma once

#include <memory>
#include <optional>

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

  /// The fate of a sample.
  enum class Taken {
    kRefused,    ///< not taken: refusal() says why
    kBegan,      ///< taken as the first one after a start, a gap or a time that ran back
    kRevised,    ///< taken; whether the last passage was a blow has turned out otherwise
    kRestarted,  ///< taken; it contradicts what came before, which does not count any more
    kContinued,  ///< taken; step() is the time since the sample before
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
  double reading() const noexcept { return measured_.angle; }  ///< angle of the judged sample [rad]
  /// Returns true if angle or speed may be in another unit that is not recognised yet.
  bool suspectsUnit() const noexcept { return unit_check_.suspects(); }
  /// Returns true if the estimate may be published. peak_force: of the last whole revolution [N], 0 before it.
  bool isSettled(const HullMotion& hull, double peak_force) noexcept;

  const CrankEstimate& estimate() const noexcept { return estimate_; }
  /// A rod that gives has the crank there.
  void considerRod(const CrankAngle& angle, double speed) noexcept;
  /// The hull's motion at the sample taken, known better since: the acceleration is that within this motion.
  void hullMoved(const HullMotion& hull) noexcept;
  const CrankStep& step() const noexcept { return step_; }
  const CrankFilter& tracker() const noexcept { return *tracker_; }
  const StampSequence& stamps() const noexcept { return sequence_; }
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

  const HullModel* model_;
  PipelineSettings settings_;
  UnitCheck unit_check_;
  std::optional<StampNs> last_raw_stamp_;  ///< stamp of the last sample, accepted or not
  CrankSample last_raw_;                   ///< last sample, accepted or not
  StampNs latency_;                        ///< latency of the header stamps
  StampSequence sequence_;
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
