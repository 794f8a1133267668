/// Follows the slider sample by sample and refuses what the working branch does not contain.
#pragma once

#include <array>
#include <cstdint>

#include "hammer_loads/grapple/grapple.h"

namespace hammer_loads {

/// Keeps the last accepted pose: a refused sample changes nothing but its counter, so the next good one continues on
/// the same branch. Knows no time: samples may come at any interval and in any order.
class GrappleTracker {
 public:
  explicit GrappleTracker(const Grapple& grapple) : grapple_(grapple) {}

  /// kNone: accepted, motion() and both jaws belong to the sample. Else nothing has changed and the refusal is counted.
  SliderRefusal update(const SliderMotion& sample) noexcept;

  /// Forgets the pose, not the counts: the next sample starts cold.
  void reset() noexcept { has_motion_ = false; }

  bool hasMotion() const noexcept { return has_motion_; }  ///< a sample has been accepted since the start or reset()
  /// Results of the last accepted sample. Precondition of these four: hasMotion().
  const SliderMotion& slider() const noexcept { return slider_; }
  const GrappleMotion& motion() const noexcept { return motion_; }
  JawMotion right() const noexcept { return rightJaw(motion_, slider_.velocity, slider_.acceleration); }
  JawMotion left() const noexcept { return leftJaw(right()); }

  /// Samples by outcome since construction; kNone counts the accepted ones.
  std::uint64_t count(SliderRefusal refusal) const noexcept { return counts_[static_cast<std::size_t>(refusal)]; }
  std::uint64_t refused() const noexcept;

  const Grapple& grapple() const noexcept { return grapple_; }

 private:
  SliderRefusal judge(const SliderMotion& sample) const noexcept;

  Grapple grapple_;
  SliderMotion slider_;
  GrappleMotion motion_;
  bool has_motion_{};
  std::array<std::uint64_t, kSliderRefusalKinds> counts_{};
};

}  // namespace hammer_loads
