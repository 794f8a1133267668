/// Cost of counting load cycles, per sample and channel.
#pragma once

#include <vector>

#include "hammer_loads/bench/cost_row.h"

namespace hammer_loads::accuracy {

/// One counter alone with the load of a hammer at work and with noise over the whole scale, every sample a turning
/// point; 20 channels with deviations; turn loads. Some 1 s.
std::vector<CostRow> lifeCosts();

}  // namespace hammer_loads::accuracy
