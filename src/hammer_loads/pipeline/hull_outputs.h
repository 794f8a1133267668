/// When the hull wrench is published and what it is then: at each sample or at a rate of its own, as it is at the
/// instant or as its mean since the output before.
#pragma once

#include <cstdint>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/crank_step.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// One publication of the hull wrench.
struct HullOutput {
  StampNs stamp{};
  double interval{};    ///< the wrench is the mean over it, before the stamp [s]; 0: at the stamp
  CrankEstimate crank;  ///< at the stamp
  HullWrench wrench;
};

/// After a restart the outputs begin with the first sample: that one is the zero of the fixed rate's grid and of the
/// first mean's interval. Means times intervals add up to the wrench's impulse whatever the rate (blows' own impulses
/// are in RockerBlow, not here). Refers to model and step, which must outlive it.
class HullOutputs {
 public:
  HullOutputs(const HullModel& model, const CrankStep& step, const PipelineSettings& settings);

  /// Outputs begin anew with the next sample.
  void forget() noexcept { begun_ = false, ready_ = false; }
  /// The step has been taken that ends with this sample.
  void sample(StampNs stamp, const CrankEstimate& crank, const HullWrench& wrench, const HullMotion& hull) noexcept;
  /// The next output up to the last sample; false when there is none left.
  bool next(HullOutput& output) noexcept;

 private:
  bool due(StampNs& stamp) const noexcept;
  void addUpTo(double time) noexcept;

  const HullModel* model_;
  const CrankStep* step_;
  OutputKind kind_;
  double rate_;
  bool begun_{}, ready_{};
  StampNs origin_{};       ///< of the grid
  std::uint64_t index_{};  ///< of the next output on the grid
  StampNs stamp_{};        ///< of the last sample
  StampNs last_output_{};
  double added_up_to_{};  ///< part of the step whose impulse is in impulse_ [s]
  HullWrench impulse_;    ///< since the last output
  CrankEstimate crank_;
  HullWrench wrench_;
  HullMotion hull_;
};

}  // namespace hammer_loads
