/// Second hypothesis on whether the rocker met the tool, kept until one of the two is clearly likelier.
#pragma once

#include <cmath>
#include <optional>

#include "hammer_loads/crank/weighed_sample.h"
#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

/// At each blow a second belief goes on without contact: a rocker that finds no tool passes the dead centre onto the
/// mirrored branch and comes back a turn later. Both beliefs take the same samples until one is far more likely. Near
/// the dead centre an elastic rod may make the right one the unlikely one: it is set aside there, and looked at again
/// behind.
class ContactRival {
 public:
  /// belief: about to pass the blow with contact.
  void begin(const CrankBelief& belief) noexcept;
  /// At a restart, which does not show whether there was contact at the last blow. estimate: as if there was.
  void beginAnew(const CrankBelief& estimate) noexcept;
  /// Behind a blow that is in question: either is as likely. estimate: as if there was contact where there was none, or
  /// the other way round.
  void ask(const CrankBelief& estimate) noexcept {
    beginAnew(estimate);
    evidence_ = 0.0;
  }
  void drop() noexcept { belief_.reset(); }
  bool isThere() const noexcept { return belief_.has_value(); }
  /// Returns true if it exists and is not set aside.
  bool isOpen() const noexcept { return belief_ && !aside_; }
  /// The estimate is clearly more likely of the wrong branch than not.
  bool isDoubtful() const noexcept { return isOpen() && evidence_ > odds::kLikely; }
  /// Probability that it is right and the estimate wrong; 0: it is not open.
  double probability() const noexcept { return isOpen() ? 1.0 / (1.0 + std::exp(-evidence_)) : 0.0; }
  /// Estimate of the hypothesis. Precondition: isThere().
  CrankBelief& belief() noexcept { return *belief_; }

  /// The second hypothesis, predicted to the sample, takes it too. Its own outliers and jolts count against it. fit:
  /// logarithm of the sample's likelihood by the estimate; growth: of variances, by the consistency.
  void follow(const WeighedSample& sample, const ShaftModel& model, double fit, double growth,
              double most_speed) noexcept;
  /// Exchanges the beliefs where the second hypothesis is far more likely: true. Sets it aside where it is far less
  /// likely, and gives it up where it still is behind the dead centre.
  bool choose(CrankBelief& estimate, bool& mirrored) noexcept;

 private:
  static constexpr double kTurnsWithout = 0.5;  // before any was seen
  // Prior: kTurnsWithout

  std::optional<CrankBelief> belief_;
  double evidence_{};  ///< logarithm of its odds against the estimate
  bool aside_{};       ///< true if it was far less likely since it began
  double turns_with_{look_back::kManyTurns}, turns_without_{kTurnsWithout};  ///< contact, so far
};

}  // namespace hammer_loads
