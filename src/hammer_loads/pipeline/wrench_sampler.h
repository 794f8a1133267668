/// Schedule and kind of the published hull wrench: at each sample or at a rate of its own, as the value at the instant
/// or as the mean since the output before.
#pragma once

#include <cstdint>
#include <vector>

#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/elastic_follower.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/pipeline/step_impulse.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// Outputs begin with the first sample after a restart. It is the origin of the fixed rate's grid and of the first
/// mean's interval. Means times intervals add up to the wrench's impulse at any rate (blows' own impulses are in
/// RockerBlow, not here). Refers to its arguments, which must outlive it.
class WrenchSampler {
 public:
  WrenchSampler(const HullModel& model, const WrenchColumns& columns, const CrankStep& step, const CrankFilter& tracker,
                const ElasticFollower& elastic, const PipelineSettings& settings);

  /// Restarts the outputs with the next sample.
  void forget() noexcept { begun_ = false; }
  /// Appends the outputs up to the result's sample, with which the step ended; links: at the sample. No allocation once
  /// the outputs have the room of mostOutputs().
  void sample(const LinksForGradient& links, const SampleResult& result, std::vector<WrenchOutput>& outputs) noexcept;
  /// Returns the standard deviations of the wrench at an instant of the last sample's step, for the given crank. time:
  /// after its start [s].
  HullDeviation deviation(double time, const CrankEstimate& crank, const SampleResult& result) const noexcept;
  /// Returns the largest number of outputs of one sample.
  std::size_t mostOutputs() const noexcept;

 private:
  bool begin(const SampleResult& result) noexcept;
  bool isDue(StampNs sample, StampNs& stamp) const noexcept;
  bool isKnown(double time, const WrenchOutput& output, const SampleResult& result) const noexcept;
  HullDeviation deviation(const CrankEstimate& crank, const CrankUncertainty& uncertainty,
                          const LinksForGradient& there, const HullMotion& hull,
                          const SampleResult& result) const noexcept;
  WrenchOutput output(StampNs stamp, const LinksForGradient& links, const SampleResult& result) noexcept;
  LoadImpulse motionTo(double time) noexcept;
  void addUpTo(double time, const SampleResult& result) noexcept;
  void setInstant(double time, const HullMotion& hull, WrenchOutput& output) const noexcept;
  void followStep(const SampleResult& result) noexcept;
  void boundMean(const LinksForGradient& links, const Eigen::Matrix3d& own, const SampleResult& result,
                 WrenchOutput& output) noexcept;

  const HullModel* model_;
  const WrenchColumns* hammer_;
  const CrankStep* step_;
  const CrankFilter* tracker_;
  const ElasticFollower* elastic_;
  OutputKind kind_;
  double rate_;         ///< [Hz]; 0: at each sample
  double longest_gap_;  ///< between samples [s]
  NearBlow near_blow_;
  double torque_part_;  ///< PipelineSettings::torque_std_part
  bool begun_{};
  StampNs origin_{};       ///< origin of the grid
  std::uint64_t index_{};  ///< index of the next output on the grid
  StampNs last_output_{};
  double added_up_to_{};  ///< part of the step whose impulse is in impulse_ [s]
  HullPath hull_;         ///< over the step to the sample
  /// SampleResult::beside at the sample and at the one before.
  Eigen::Matrix3d other_covariance_{Eigen::Matrix3d::Zero()}, other_covariance_before_{Eigen::Matrix3d::Zero()};
  DriveReaction drive_;                              ///< at the sample
  LoadImpulse impulse_;                              ///< since the last output
  LoadColumns columns_{LoadColumns::Zero()};         ///< columns up to which the mean is summed
  LoadColumns column_impulse_{LoadColumns::Zero()};  ///< since the last output, of a mean
  HullWrench momentum_std_;                          ///< at the last output
  HullWrench blow_deviation_;                        ///< ElasticFollower::Impulse::doubt since the last output
};

}  // namespace hammer_loads
