/// Cost table, the headline: errors of the damage-equivalent ranges, on which fatigue is judged.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/bench/boom_table.h"
#include "hammer_loads/bench/elastic_table.h"

namespace hammer_loads::accuracy {

/// As a table in Markdown: of hull force z, the worst joint's torque and bending at the worst cut, by the machine and
/// its sensors; of machines whose rod gives, at levels linkage and elastic, hull force z alone.
std::string lifeMarkdown(const std::vector<BoomRow>& boom, const std::vector<ElasticRow>& elastic);

}  // namespace hammer_loads::accuracy
