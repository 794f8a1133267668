/// Two passes over a recording's runs: one ahead, whose filter fills a track per run, one behind, which gets the
/// smoothed samples.
#pragma once

#include <deque>
#include <memory>

#include "hammer_loads/crank/crank_track.h"
#include "hammer_loads/pipeline/make_tracker.h"

namespace hammer_loads {

/// Both passes take the same messages through pipelines with the same settings; before the pass behind takes one,
/// isReady() must hold.
class SmoothedRuns {
 public:
  /// Of the pass ahead. The tracker of a run must be gone before that of the next one is made.
  TrackerMaker ahead();
  /// Of the pass behind, run by run.
  TrackerMaker behind();
  /// The pass ahead is through.
  void end() { ended_ = true; }
  /// The pass behind can take another message, whatever it is.
  bool isReady() const;

 private:
  std::deque<std::shared_ptr<CrankTrack>> tracks_;  ///< the first one is at work behind, the last one ahead
  bool behind_begun_{};                             ///< the first one has its tracker
  bool ended_{};
};

}  // namespace hammer_loads
