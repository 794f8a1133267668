/// One step of the way back from a sample to the one before: what the later samples say of the earlier one.
#pragma once

#include <optional>

#include "hammer_loads/crank/crank_belief.h"

namespace hammer_loads {

/// How the filter came from one sample to the next.
struct FilterStep {
  double length{};          ///< [s]
  HullMotion hull;          ///< its mean over the step
  const BlowPrior& prior;   ///< of a blow within it
  const CrankWalks& walks;  ///< random walks
  double most_speed{};      ///< from which on an estimate has diverged [rad/s]
};

/// Rauch, Tung and Striebel's step: the belief at the earlier sample by all samples, where `next` is that at the later
/// one by all samples and `before`, `now` are what the filter had at both by those up to each. The transition is the
/// filter's own, through a blow as well; the blow's factor is drawn anew there, so nothing of it goes back beyond.
/// Linear about `before`: the result may stand a little beyond a blow that it has not passed.
///
/// Nothing where the step is none that the model makes: the filter took up something that it did not expect (its
/// variances grew), went onto another branch, or a blow was not where the model has it (a tool met early).
std::optional<CrankBelief> smoothedBelief(ShaftModel model, const FilterStep& step, const CrankBelief& before,
                                          const CrankBelief& now, const CrankBelief& next) noexcept;

/// Brings a belief that stands beyond a blow to the branch where it is: passes the blow or, turned back, undoes it.
/// factor: of that blow on the crank's speed.
void settleBranch(const ShaftModel& model, double factor, CrankBelief& belief) noexcept;

}  // namespace hammer_loads
