/// Load cycles of a run, and the loads of each of its revolutions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/turn_loads.h"
#include "hammer_loads/pipeline/channel_values.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/pipeline/step_wrenches.h"

namespace hammer_loads {

/// Counts the loads of a pipeline's samples in time order. Every channel counts at each sample with published loads.
/// The hull wrench counts between two such samples if they agree: at its extremes, and as close to both sides of a blow
/// as it is known. No load is counted before the encoder's zero is known (ZeroWatch::mayCount()). The pipeline is
/// independent of it. Sequence of a run:
///
///     const SampleResult& result = pipeline.crankSample(...);
///     if (follower.due()) use(follower.take());
///     follower.follow();
///     for each of result.ends: follower.turnLoads(end);
class LifeFollower {
 public:
  /// Refers to the pipeline, which must outlive it. settings: checked against channelNames() of its boom.
  LifeFollower(const Pipeline& pipeline, const life::LifeSettings& settings);

  /// Returns true if the piece ends before the pipeline's last sample.
  bool due() const noexcept;
  /// Ends the piece and adds it to the total. Allocates.
  life::LifePiece take();
  /// Takes the pipeline's last sample; call once per sample. No allocation.
  void follow() noexcept;
  /// Takes the ends of Pipeline::end().
  void end() noexcept { confirmTurns(pipeline_->result()); }
  /// Returns the loads of a revolution among the result's ends; null where no sample near its blow was accepted.
  const life::TurnLoads* turnLoads(const TurnEnd& end) const noexcept;

  const std::vector<std::string>& channels() const noexcept { return channels_; }
  const life::LifeRecorder& recorder() const noexcept { return recorder_; }
  /// Returns the sum of all results of take(); empty before its first call.
  const std::optional<life::LifePiece>& total() const noexcept { return total_; }
  std::optional<StampNs> since() const noexcept { return since_; }  ///< first sample counted

 private:
  struct StepEnd;
  void count(const SampleResult& result) noexcept;
  void followStep(const SampleResult& result) noexcept;
  void followRing(const SampleResult& result) noexcept;
  void countBetween(StampNs stamp) noexcept;
  bool moveToKnown(StepPlace& place, CrankEstimate& crank) const noexcept;
  void keepWhatBothEndsSay(const StepLoad& load, const StepPlace& place, const CrankEstimate& crank,
                           const StepEnd& end) noexcept;
  double ownOfBoth(std::size_t channel, const StepEnd& end) const noexcept;
  void endTurn(StampNs stamp) noexcept;
  void confirmTurns(const SampleResult& result) noexcept;

  const Pipeline* pipeline_;
  const Boom* boom_;  ///< null: none
  std::vector<std::string> channels_;
  life::LifeRecorder recorder_;
  std::optional<BandMeans> means_;  ///< counted in place of the samples where a bandwidth is given
  life::TurnLoadsRecorder turn_;
  std::optional<life::LifePiece> total_;
  std::optional<StampNs> since_, last_;  ///< first and last sample counted; last_: none after a gap
  bool uncertain_{};                     ///< SampleResult::uncertain of the last sample
  std::optional<StampNs> last_blow_;     ///< stamp of the last confirmed blow
  /// Revolutions whose blow is not measured yet, and those just measured: one more than a result has ends.
  std::array<life::TurnLoads, std::tuple_size<decltype(SampleResult::ends)>::value + 1> turns_;
  std::size_t next_turn_{};                                        ///< in turns_
  std::vector<double> values_, deviations_, common_;               ///< at the last sample counted
  std::vector<double> between_, deviations_there_, common_there_;  ///< between two samples: known for the wrench only
};

}  // namespace hammer_loads
