/// Reasons for samples without a wrench, and their counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "hammer_loads/pipeline/misuse.h"

namespace hammer_loads {

/// Reason why a crank sample gave no wrench.
enum class Refusal : std::size_t {
  kMissingJoint,  ///< the crank joint is not in the message
  kShortArray,    ///< fewer positions (or, where there are any, speeds) than names
  kNotFinite,     ///< NaN or infinity
  kImplausible,   ///< faster than any crank, or contradicting the samples before it
  kOutOfOrder,    ///< older than the last accepted sample
  kDuplicate,     ///< stamp equal to that of the last accepted sample
  kBadStamp,      ///< beyond the last time that a message can carry
  kDegrees,       ///< crank or boom are recognised to send degrees: withheld until that is over
  kSpeedUnit,     ///< crank speed recognised to be in rpm or revolutions per second: withheld until that is over
  kAngleUnit,     ///< crank angle recognised to be in revolutions: withheld until that is over
  kBackward,      ///< the crank turns backward: withheld until it has made half a revolution forward
  kInconsistent,  ///< readings contradict the model, and have for some time: withheld until they agree
  kUnsettled,     ///< used, but the estimate is not good enough to publish (start without speed, after a drop-out)
  kCount
};

constexpr std::array<const char*, static_cast<std::size_t>(Refusal::kCount)> kRefusalNames{
    "missing joint", "short array", "not finite", "implausible", "out of order", "duplicate", "bad stamp",
    "degrees",       "speed unit",  "angle unit", "backward",    "inconsistent", "unsettled"};

constexpr bool isOfUnit(Refusal reason) noexcept {
  return reason == Refusal::kDegrees || reason == Refusal::kSpeedUnit || reason == Refusal::kAngleUnit;
}

/// Crank samples since the start.
struct SampleCounts {
  std::uint64_t accepted{};
  std::array<std::uint64_t, static_cast<std::size_t>(Refusal::kCount)> refused{};
  std::uint64_t beside_blow{};       ///< accepted samples that are not published because of the blow, see SampleResult
  std::uint64_t uncertain{};         ///< other accepted samples that are not published, see SampleResult
  std::uint64_t restarts{};          ///< drop-outs, jumps and time running back
  std::uint64_t blows{};             ///< forward passages, for the first time, not creeping
  std::uint64_t impossible_blows{};  ///< not included in blows: RockerBlow::impossible
  std::uint64_t backward_passes{};   ///< backward passages of the blow, minus those forward again
  MisuseCounts misuse;

  /// Returns the number of samples withheld because the readings are in another unit.
  std::uint64_t inOtherUnit() const noexcept {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < refused.size(); ++i) sum += isOfUnit(static_cast<Refusal>(i)) ? refused[i] : 0;
    return sum;
  }
  /// Returns the number of samples withheld because the readings contradict the model.
  std::uint64_t contradicting() const noexcept {
    return inOtherUnit() + refusedFor(Refusal::kBackward) + refusedFor(Refusal::kInconsistent);
  }
  /// Returns true if most readings since `before` contradict the model. A wrong unit is permanent but shows only at
  /// work, so that a tenth of the readings is enough.
  bool contradictSince(const SampleCounts& before) const noexcept {
    constexpr std::uint64_t kUnitTells = 10;
    // Limit: kUnitTells
    const std::uint64_t good = accepted - before.accepted;
    return contradicting() - before.contradicting() > good ||
           kUnitTells * (inOtherUnit() - before.inOtherUnit()) > good;
  }
  std::uint64_t refusedFor(Refusal reason) const noexcept { return refused[static_cast<std::size_t>(reason)]; }
  std::uint64_t refusedTotal() const noexcept {
    return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
  }
};

}  // namespace hammer_loads
