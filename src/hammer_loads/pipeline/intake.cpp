#include "hammer_loads/pipeline/intake.h"

#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kLargestAngle = 1e9;  // [rad]: beyond it a double resolves less than an encoder count

}  // namespace

Intake::Verdict Intake::judge(StampNs stamp, const CrankSample& sample) noexcept {
  const double speed = sample.speed.value_or(0.0);
  if (!std::isfinite(sample.angle) || !std::isfinite(speed)) return {Refusal::kNotFinite};
  if (std::abs(sample.angle) > kLargestAngle || std::abs(speed) > max_speed_) return {Refusal::kImplausible};
  if (!last_) return {};
  if (stamp == *last_) return {Refusal::kDuplicate};
  if (stamp < *last_) {
    const bool again = rewound_ && stamp > *rewound_;
    rewound_ = stamp;
    if (!again) return {Refusal::kOutOfOrder};
    rewound_.reset();
    return {};  // a new beginning
  }
  rewound_.reset();
  const double step = static_cast<double>(stamp - *last_) * kSecondsPerNs;
  if (step > stale_after_) return {};
  return {std::nullopt, Order::kNext, step};
}

}  // namespace hammer_loads
