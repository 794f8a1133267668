#include "hammer_loads/grapple/grapple_tracker.h"

#include <cmath>

namespace hammer_loads {

SliderRefusal GrappleTracker::judge(const SliderMotion& sample) const noexcept {
  if (!std::isfinite(sample.velocity) || !std::isfinite(sample.acceleration)) return SliderRefusal::kNotFinite;
  return grapple_.judgeInStroke(sample.position);
}

SliderRefusal GrappleTracker::update(const SliderMotion& sample) noexcept {
  SliderRefusal refusal = judge(sample);
  if (refusal == SliderRefusal::kNone) {
    const std::optional<GrappleMotion> next =
        hasMotion() ? grapple_.follow(motion_, sample.position) : grapple_.at(sample.position);
    if (next) {
      motion_ = *next;
      slider_ = sample;
      has_motion_ = true;
    } else {
      refusal = SliderRefusal::kNotFound;
    }
  }
  ++counts_[static_cast<std::size_t>(refusal)];
  return refusal;
}

std::uint64_t GrappleTracker::refused() const noexcept {
  std::uint64_t sum = 0;
  for (std::size_t i = 1; i < counts_.size(); ++i) sum += counts_[i];
  return sum;
}

}  // namespace hammer_loads
