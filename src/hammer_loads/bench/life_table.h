/// Cost table, the headline: errors of the damage-equivalent ranges, on which fatigue is judged.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/bench/boom_table.h"
#include "hammer_loads/bench/elastic_table.h"

namespace hammer_loads::accuracy {

/// Errors as a table in Markdown: hull force z, the worst joint's torque and bending at the worst cut, by the machine
/// and its sensors. For machines with an elastic connecting rod, at levels linkage and elastic, hull force z alone.
std::string lifeMarkdown(const std::vector<BoomRow>& boom, const std::vector<ElasticRow>& elastic);

}  // namespace hammer_loads::accuracy
