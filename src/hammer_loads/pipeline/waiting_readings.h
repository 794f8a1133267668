/// Readings of an IMU that wait until what they are compared with is known.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "hammer_loads/pipeline/hull_imu.h"

namespace hammer_loads {

/// In the order they came in; of more than 64 the oldest is dropped. No allocation.
class WaitingReadings {
 public:
  void add(const StampedImuReading& reading) noexcept {
    if (count_ == kMost) drop(1);
    readings_[count_++] = reading;
  }
  /// each(reading) of the first ones, up to a stamp: they wait no longer.
  template <typename Each>
  void takeUpTo(StampNs stamp, const Each& each) noexcept {
    std::size_t taken = 0;
    while (taken < count_ && readings_[taken].stamp <= stamp) each(readings_[taken++]);
    if (taken > 0) drop(taken);
  }
  /// Number of readings up to a stamp. Readings that wait for a bus may be later.
  std::ptrdiff_t upTo(StampNs stamp) const noexcept {
    return std::count_if(readings_.begin(), readings_.begin() + static_cast<std::ptrdiff_t>(count_),
                         [stamp](const StampedImuReading& reading) { return reading.stamp <= stamp; });
  }

 private:
  static constexpr std::size_t kMost = 64;

  void drop(std::size_t first) noexcept {
    std::move(readings_.begin() + static_cast<std::ptrdiff_t>(first),
              readings_.begin() + static_cast<std::ptrdiff_t>(count_), readings_.begin());
    count_ -= first;
  }

  std::array<StampedImuReading, kMost> readings_;
  std::size_t count_{};
};

}  // namespace hammer_loads
