/// Readings that arrive before the crank sample to which they belong.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Queue of the readings of one topic that are ahead of the crank. A delayed node receives its messages in bursts,
/// topic by topic: the readings of some tenths of a second, then the crank samples of that time. A reading waits for
/// the first crank sample that is not older. One reading beyond the last crank sample does not wait, so that the
/// pipeline can interpolate. The order within the topic is kept.
///
/// The result depends on stamps and order of arrival alone, so that a recording gives the same result.
template <typename Reading>
class ReadingQueue {
 public:
  using Pass = std::function<void(StampNs, const Reading&)>;

  /// pass: called for each reading that no longer waits.
  explicit ReadingQueue(Pass pass) : pass_(std::move(pass)) {}

  /// Takes a reading. crank: stamp of the last crank sample; none: there was no sample yet, and all readings but the
  /// first one wait. Readings wait for 1 s at most. If one is further ahead, its stamp is from another clock or the
  /// crank has stopped.
  void add(StampNs stamp, const Reading& reading, std::optional<StampNs> crank) {
    const bool is_beyond = !crank || (stamp > *crank && seconds(stamp - *crank) <= kLongestWait);
    const bool waits = is_beyond && passed_ && (!crank || *passed_ >= *crank);
    const bool in_order = waiting_.empty() || stamp > waiting_.back().stamp;
    if (!waits || !in_order) passAll();
    if (waits) {
      waiting_.push_back({stamp, reading});
      passWhile([stamp](const Waiting& first) { return seconds(stamp - first.stamp) > kLongestWait; });
    } else {
      passed_ = stamp;
      pass_(stamp, reading);
    }
  }
  /// Passes on the readings that a crank sample at this stamp needs.
  void passUpTo(StampNs crank) {
    passWhile([this, crank](const Waiting&) { return *passed_ < crank; });
  }
  void passAll() {
    passWhile([](const Waiting&) { return true; });
  }

 private:
  static constexpr double kLongestWait = 1.0;  ///< [s]

  struct Waiting {
    StampNs stamp;
    Reading reading;
  };

  template <typename Goes>
  void passWhile(const Goes& goes) {
    auto next = waiting_.begin();
    for (; next != waiting_.end() && goes(*next); ++next) {
      passed_ = next->stamp;
      pass_(next->stamp, next->reading);
    }
    waiting_.erase(waiting_.begin(), next);
  }

  Pass pass_;
  std::vector<Waiting> waiting_;   ///< in the order of their stamps
  std::optional<StampNs> passed_;  ///< stamp of the last reading passed on
};

}  // namespace hammer_loads
