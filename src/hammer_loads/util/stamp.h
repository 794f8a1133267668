/// Header stamps, the only time that the rooms without ROS know, and their order.
#pragma once

#include <cstdint>
#include <optional>

namespace hammer_loads {

/// Header stamp [ns].
using StampNs = std::int64_t;

constexpr double kSecondsPerNs = 1e-9;
/// Last stamp that a message can carry [ns]: 2^32 - 1 whole seconds and the nanoseconds up to the next.
constexpr StampNs kLastStamp = 4294967295999999999;

/// Length of a time [s].
constexpr double seconds(StampNs length) noexcept { return static_cast<double>(length) * kSecondsPerNs; }

class StampOrder {
 public:
  enum class Place {
    kFirst,       ///< the first one after a start, a gap or a jump back in time
    kNext,        ///< after the last accepted sample
    kDuplicate,   ///< stamp equal to that of the last accepted sample
    kOutOfOrder,  ///< older than it
  };
  struct Verdict {
    Place place{Place::kFirst};
    double step{};  ///< since the last accepted sample [s], for kNext
  };

  /// stale_after: age of the last sample from which on a new one restarts [s].
  explicit StampOrder(double stale_after) : stale_after_(stale_after) {}

  /// A jump back in time is accepted with the second sample, since the first one may be late.
  Verdict judge(StampNs stamp) noexcept {
    if (!last_) return {};
    if (stamp == *last_) return {Place::kDuplicate};
    if (stamp < *last_) {
      const bool again = rewound_ && stamp > *rewound_;
      rewound_ = stamp;
      if (!again) return {Place::kOutOfOrder};
      rewound_.reset();
      return {};
    }
    rewound_.reset();
    const double step = seconds(stamp - *last_);
    if (step > stale_after_) return {};
    return {Place::kNext, step};
  }
  void accept(StampNs stamp) noexcept { last_ = stamp; }
  void reset() noexcept { last_.reset(), rewound_.reset(); }
  const std::optional<StampNs>& last() const noexcept { return last_; }

 private:
  double stale_after_;
  std::optional<StampNs> last_;     ///< stamp of the last accepted sample
  std::optional<StampNs> rewound_;  ///< stamp of the last sample, if it was refused as out of order
};

}  // namespace hammer_loads
