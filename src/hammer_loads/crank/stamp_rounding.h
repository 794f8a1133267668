/// Stamps that are whole milliseconds, or the like.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace hammer_loads {

/// A clock that is read in whole steps rounds down, up or to the nearest: the stamps do not say which, and all samples
/// are off alike by up to half a step from their middle. Stamps at even steps may be exact; those that are rounded are
/// uneven by whole steps.
class StampRounding {
 public:
  /// From one stamp to the next [ns].
  void add(std::int64_t difference) noexcept {
    while (step_ < kSteps.size() && !isWhole(difference, kSteps[step_])) ++step_, stamps_ = uneven_ = 0;
    if (step_ == kSteps.size()) return;
    if (stamps_ > 0) uneven_ += std::llabs(difference - last_) > kTolerance;
    last_ = difference;
    if (++stamps_ < kMany) return;
    rounded_ = uneven_ > kMany / 10;
    stamps_ = 1, uneven_ = 0;
  }
  double step() const noexcept {
    return rounded_ && step_ < kSteps.size() ? 1e-9 * static_cast<double>(kSteps[step_]) : 0.0;
  }  ///< [s]

 private:
  static constexpr std::array<std::int64_t, 6> kSteps{10000000, 5000000, 2000000, 1000000, 500000, 100000};  ///< [ns]
  static constexpr std::int64_t kTolerance = 1000;  // [ns]: of stamps that were numbers of seconds on their way
  static constexpr int kMany = 100;                 // stamps that are judged together
  // Guard: StampRounding.IsKnownAfterAHundredStamps of kMany
  // Guard: StampRounding.StampsWithinAMicrosecondAreWhole of kTolerance

  static bool isWhole(std::int64_t difference, std::int64_t step) noexcept {
    const std::int64_t rest = std::llabs(difference) % step;
    return rest <= kTolerance || step - rest <= kTolerance;
  }

  std::size_t step_{};  ///< of kSteps, the largest that all stamps are multiples of
  std::int64_t last_{};
  int stamps_{}, uneven_{};
  bool rounded_{};
};

}  // namespace hammer_loads
