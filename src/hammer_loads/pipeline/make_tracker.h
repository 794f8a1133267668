/// The filter that follows the crank.
#pragma once

#include <functional>
#include <memory>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// Refers to the mechanism, which must outlive it.
std::unique_ptr<CrankTracker> makeTracker(const Mechanism& mechanism, const PipelineSettings& settings);

/// Another way to make one, with the same contract.
using TrackerMaker =
    std::function<std::unique_ptr<CrankTracker>(const Mechanism& mechanism, const PipelineSettings& settings)>;

/// Of that filter.
CrankFilterSettings filterSettings(const Mechanism& mechanism, const PipelineSettings& settings);

}  // namespace hammer_loads
