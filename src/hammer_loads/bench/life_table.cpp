#include "hammer_loads/bench/life_table.h"

#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {

std::string lifeMarkdown(const std::vector<BoomRow>& boom, const std::vector<ElasticRow>& elastic) {
  std::string text = "| machine | sensors | hull force z | joint torque | bending |\n|---|---|---|---|---|\n";
  for (const BoomRow& r : boom)
    text += format("| %s | %s | %+.1f %% | %+.1f %% | %+.1f %% |\n", r.machine.c_str(), r.sensors.c_str(),
                   100.0 * r.life_force, 100.0 * r.life_torque, 100.0 * r.life_section);
  for (const ElasticRow& r : elastic)
    if (r.level != Level::kRocker)
      text += format("| %s, level %s | none | %+.1f %%; with the touch %+.1f %% | | |\n", r.machine.c_str(),
                     nameOf(r.level), 100.0 * r.errors.life, 100.0 * r.errors.life_with_touch);
  return text +
         "| *others: towers of wind turbines, simulated* | | | | 5 to 10 % |\n"
         "| *others: measured; corrected in the field* | | | | 10 to 15 %; below 5 % |\n";
}

}  // namespace hammer_loads::accuracy
