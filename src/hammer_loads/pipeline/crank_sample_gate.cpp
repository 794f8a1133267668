#include "hammer_loads/pipeline/crank_sample_gate.h"

#include <cmath>

#include "hammer_loads/hammer/hammer_model.h"

namespace hammer_loads {
namespace {

constexpr double kLargestAngle = 1e9;  // [rad]: beyond it a double resolves less than an encoder count
// Limit: kLargestAngle

}  // namespace

std::optional<Refusal> CrankSampleGate::refusalOf(const CrankSample& sample) const noexcept {
  const double speed = sample.speed.value_or(0.0);
  if (!std::isfinite(sample.angle) || !std::isfinite(speed)) return Refusal::kNotFinite;
  if (std::abs(sample.angle) > kLargestAngle || std::abs(speed) > limits_.max_speed) return Refusal::kImplausible;
  return std::nullopt;
}

CrankSampleGate::Verdict CrankSampleGate::judge(StampNs stamp, const CrankSample& sample) noexcept {
  if (stamp < 0 || stamp > kLastStamp) return {Refusal::kBadStamp};
  if (const std::optional<Refusal> refusal = refusalOf(sample)) return {refusal};
  const auto [place, step] = stamps_.judge(stamp);
  switch (place) {
    case StampOrder::Place::kDuplicate:
      return {Refusal::kDuplicate};
    case StampOrder::Place::kOutOfOrder:
      return {Refusal::kOutOfOrder};
    case StampOrder::Place::kFirst:
    case StampOrder::Place::kNext:
      break;
  }
  if (isFrozen(step, sample)) return {Refusal::kImplausible};
  return {std::nullopt, place == StampOrder::Place::kFirst ? Order::kFirst : Order::kNext, step, isSpeedDead(sample)};
}

/// A sensor's angle may be frozen while its speed changes.
bool CrankSampleGate::isFrozen(double step, const CrankSample& sample) noexcept {
  const double speed = std::abs(sample.speed.value_or(0.0)), turn = speed * step;
  const bool turns = speed > limits_.frozen_speed && (frozen_ || (turn > limits_.frozen_turn && turn < 0.5 * kTwoPi));
  // Compares all bits, since counts repeat exactly and the noise of any working sensor changes some bits.
  frozen_ = turns && sample.angle == accepted_.angle;
  return frozen_;
}

bool CrankSampleGate::isSpeedDead(const CrankSample& sample) const noexcept {
  return sample.speed == 0.0 && accepted_.speed == 0.0 &&
         std::abs(CrankAngle::wrapToPi(sample.angle - accepted_.angle)) > limits_.frozen_turn;
}

}  // namespace hammer_loads
