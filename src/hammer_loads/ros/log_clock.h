/// Record times that keep the order of arrival.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <ros/time.h>

namespace hammer_loads {

/// Gives each input its record time: now, but at least 1 ns after the input before it. So the record times of the
/// inputs are all different and rise in their order of arrival, whatever the clock does (two inputs in one tick,
/// /clock absent, standing still or jumping back), and reading a bag in time order gives the inputs as they came.
/// An output is recorded at the time of the input that caused it.
class RecordClock {
 public:
  /// Record time of the next input; at the end of ros::Time's range (year 2106) it stands still instead of failing.
  ros::Time next(const ros::Time& now) noexcept {
    constexpr std::uint64_t kGiga = 1'000'000'000u;
    constexpr std::uint64_t kLast = std::numeric_limits<std::uint32_t>::max() * kGiga + (kGiga - 1);
    last_ = std::min(std::max<std::uint64_t>(now.sec * kGiga + now.nsec, last_ + 1), kLast);
    ros::Time time;
    time.sec = static_cast<std::uint32_t>(last_ / kGiga);
    time.nsec = static_cast<std::uint32_t>(last_ % kGiga);
    return time;
  }

 private:
  std::uint64_t last_{};  // [ns]
};

}  // namespace hammer_loads
