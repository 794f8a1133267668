/// Second hypothesis on whether the rocker met the tool, kept until one of the two is clearly likelier.
#pragma once

#include <cmath>
#include <optional>

#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

/// At each blow a second belief continues without contact: a rocker that meets no tool passes the dead centre onto the
/// mirrored branch and returns a revolution later. Both beliefs are updated by the same samples until one is far more
/// likely. Near the dead centre an elastic rod may make the correct belief unlikely; it is suspended there and examined
/// again after it.
class ContactHypothesis {
 public:
  /// belief: about to pass the blow with contact.
  void begin(const CrankBelief& belief) noexcept;
  /// Begins at a restart, where it is not known whether there was contact at the last blow. estimate: with contact.
  void beginAnew(const CrankBelief& estimate) noexcept;
  /// Begins after a doubtful blow; both hypotheses are equally likely. estimate: that of the other hypothesis.
  void beginWithEvenOdds(const CrankBelief& estimate) noexcept {
    beginAnew(estimate);
    evidence_ = 0.0;
  }
  void drop() noexcept { belief_.reset(); }
  bool isThere() const noexcept { return belief_.has_value(); }
  /// Returns true if it exists and is not suspended.
  bool isOpen() const noexcept { return belief_ && !aside_; }
  /// Returns true if the estimate is clearly more likely to be on the wrong branch.
  bool isUncertain() const noexcept { return isOpen() && evidence_ > odds::kLikely; }
  /// Probability of the second hypothesis; 0 if there is none.
  double probability() const noexcept { return isOpen() ? 1.0 / (1.0 + std::exp(-evidence_)) : 0.0; }
  /// Estimate of the hypothesis. Precondition: isThere().
  CrankBelief& belief() noexcept { return *belief_; }

  /// Updates the second hypothesis, predicted to the sample. Its outliers and jolts count against it. fit: logarithm of
  /// the sample's likelihood by the estimate; growth: factor on variances from the consistency.
  void follow(const WeighedSample& sample, const ShaftModel& model, double fit, double growth,
              double most_speed) noexcept;
  /// Exchanges the beliefs and returns true if the second hypothesis is far more likely. Suspends it if it is far less
  /// likely, and discards it if it still is after the dead centre.
  bool choose(CrankBelief& estimate, bool& mirrored) noexcept;

 private:
  static constexpr double kTurnsWithout = 0.5;  // weight before any was observed
  // Prior: kTurnsWithout

  std::optional<CrankBelief> belief_;
  double evidence_{};  ///< logarithm of its odds against the estimate
  bool aside_{};       ///< true if it was far less likely since it began
  double turns_with_{look_back::kManyTurns}, turns_without_{kTurnsWithout};  ///< decisions so far
};

}  // namespace hammer_loads
