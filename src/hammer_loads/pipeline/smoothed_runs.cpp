#include "hammer_loads/pipeline/smoothed_runs.h"

#include "hammer_loads/crank/recorded_crank.h"
#include "hammer_loads/crank/smoothed_crank.h"

namespace hammer_loads {

TrackerMaker SmoothedRuns::ahead() {
  return [this](const Mechanism& mechanism, const PipelineSettings& settings) -> std::unique_ptr<CrankTracker> {
    tracks_.push_back(std::make_shared<CrankTrack>(mechanism, settings.level, mechanism.parameters().drive_inertia,
                                                   filterSettings(mechanism, settings), settings.coupling));
    return std::make_unique<RecordedCrank>(tracks_.back());
  };
}

TrackerMaker SmoothedRuns::behind() {
  return [this](const Mechanism& mechanism, const PipelineSettings& settings) -> std::unique_ptr<CrankTracker> {
    if (behind_begun_) tracks_.pop_front();
    behind_begun_ = true;
    const ShaftModel model(mechanism, settings.level, settings.coupling);
    return std::make_unique<SmoothedCrank>(
        model, CrankFilter(model, mechanism.parameters().drive_inertia, filterSettings(mechanism, settings)),
        tracks_.front());
  };
}

/// A message may be the next run's first one.
bool SmoothedRuns::isReady() const {
  for (const std::shared_ptr<CrankTrack>& track : tracks_) {
    if (track->isReady()) return true;
    if (!track->isClosed()) return ended_;
  }
  return ended_;
}

}  // namespace hammer_loads
