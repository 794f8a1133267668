/// Follows the slider sample by sample and refuses what the working branch does not contain.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "hammer_loads/grapple/grapple.h"

namespace hammer_loads {

/// Keeps the last accepted pose: a refused sample changes nothing but its counter, so the next good one continues on
/// the same branch. Knows no time: samples may come at any interval and in any order.
class GrappleTracker {
 public:
  explicit GrappleTracker(const Grapple& grapple) : grapple_(grapple) {}

  /// kNone: accepted, motion() and both jaws belong to the sample. Else nothing has changed and the refusal is counted.
  SliderRefusal update(const SliderMotion& sample) noexcept {
    const bool finite = std::isfinite(sample.velocity) && std::isfinite(sample.acceleration);
    SliderRefusal refusal = finite ? grapple_.judgeInStroke(sample.position) : SliderRefusal::kNotFinite;
    if (refusal == SliderRefusal::kNone) {
      const std::optional<GrappleMotion> next =
          hasMotion() ? grapple_.follow(*motion_, sample.position) : grapple_.at(sample.position);
      if (next) {
        motion_ = next;
        slider_ = sample;
      } else {
        refusal = SliderRefusal::kNotFound;
      }
    }
    ++counts_[static_cast<std::size_t>(refusal)];
    return refusal;
  }

  /// Forgets the pose, not the counts: the next sample starts cold.
  void reset() noexcept { motion_.reset(); }

  bool hasMotion() const noexcept {
    return motion_.has_value();
  }  ///< a sample has been accepted since the start or reset()
  /// Results of the last accepted sample. Precondition of these four: hasMotion().
  const SliderMotion& slider() const noexcept { return slider_; }
  const GrappleMotion& motion() const noexcept { return *motion_; }
  JawMotion right() const noexcept { return rightJaw(*motion_, slider_.velocity, slider_.acceleration); }
  JawMotion left() const noexcept { return leftJaw(right()); }

  /// Samples by outcome since construction; kNone counts the accepted ones.
  std::uint64_t count(SliderRefusal refusal) const noexcept { return counts_[static_cast<std::size_t>(refusal)]; }
  std::uint64_t refused() const noexcept {
    return std::accumulate(counts_.begin() + 1, counts_.end(), std::uint64_t{0});
  }

  const Grapple& grapple() const noexcept { return grapple_; }

 private:
  Grapple grapple_;
  SliderMotion slider_;
  std::optional<GrappleMotion> motion_;
  std::array<std::uint64_t, kSliderRefusalKinds> counts_{};
};

}  // namespace hammer_loads
