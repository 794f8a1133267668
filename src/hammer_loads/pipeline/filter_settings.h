/// Settings of the crank's filter.
#pragma once

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// Returns the settings from the parameters of hammer and pipeline.
CrankFilterSettings filterSettings(const Mechanism& mechanism, const PipelineSettings& settings);

}  // namespace hammer_loads
