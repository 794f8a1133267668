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
  const auto [place, step] = stamps_.judge(stamp);
  switch (place) {
    case StampOrder::Place::kDuplicate:
      return {Refusal::kDuplicate};
    case StampOrder::Place::kOutOfOrder:
      return {Refusal::kOutOfOrder};
    case StampOrder::Place::kFirst:
      return {};
    case StampOrder::Place::kNext:
      break;
  }
  return {std::nullopt, Order::kNext, step};
}

}  // namespace hammer_loads
