/// Readings that arrive before the crank sample to which they belong.
#pragma once

#include <optional>
#include <vector>

#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Queue of the readings of one topic that are ahead of the crank. A node that is held up receives its messages in
/// bursts, topic by topic: the readings of some tenths of a second, then the crank samples of that time. Each reading
/// is passed on with the first crank sample that is not older, except for one reading beyond the last sample, between
/// which and the one before it the pipeline interpolates. The order within the topic is kept.
///
/// The result depends on stamps and order of arrival alone, so that a recording gives the same.
template <typename Reading>
class ReadingQueue {
 public:
  /// Takes a reading. crank: stamp of the last crank sample; none: there was no sample yet, and all readings but the
  /// first one wait. pass(stamp, reading): called for each reading that does not wait any more. Readings wait for 1 s
  /// at most: further ahead are stamps of another clock, or the crank has stopped.
  template <typename Pass>
  void add(StampNs stamp, const Reading& reading, std::optional<StampNs> crank, const Pass& pass) {
    const bool is_beyond = !crank || (stamp > *crank && seconds(stamp - *crank) <= kLongestWait);
    const bool is_ahead = is_beyond && passed_ && (!crank || *passed_ >= *crank);
    const bool in_order = waiting_.empty() || stamp > waiting_.back().stamp;
    if (!is_ahead || !in_order) passAll(pass);
    if (is_ahead) {
      waiting_.push_back({stamp, reading});
      passWhile([&](const Waiting& first) { return seconds(stamp - first.stamp) > kLongestWait; }, pass);
    } else {
      passed_ = stamp;
      pass(stamp, reading);
    }
  }
  /// Passes on what a crank sample at this stamp needs.
  template <typename Pass>
  void passUpTo(StampNs crank, const Pass& pass) {
    passWhile([&](const Waiting&) { return *passed_ < crank; }, pass);
  }
  template <typename Pass>
  void passAll(const Pass& pass) {
    passWhile([](const Waiting&) { return true; }, pass);
  }

 private:
  static constexpr double kLongestWait = 1.0;  ///< [s]

  struct Waiting {
    StampNs stamp;
    Reading reading;
  };

  template <typename Goes, typename Pass>
  void passWhile(const Goes& goes, const Pass& pass) {
    auto next = waiting_.begin();
    for (; next != waiting_.end() && goes(*next); ++next) {
      passed_ = next->stamp;
      pass(next->stamp, next->reading);
    }
    waiting_.erase(waiting_.begin(), next);
  }

  std::vector<Waiting> waiting_;   ///< in the order of their stamps
  std::optional<StampNs> passed_;  ///< stamp of the last reading passed on
};

}  // namespace hammer_loads
