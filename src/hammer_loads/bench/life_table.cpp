#include "hammer_loads/bench/life_table.h"

#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

std::string said(const LifeFigure& f) { return format("%.1f, %.1f %%", 100.0 * f.own, 100.0 * f.common); }
std::string cells(const LifeFigure& f) { return format(" %+.1f %% | ", 100.0 * f.error) + said(f) + " |"; }

}  // namespace

std::string lifeMarkdown(const std::vector<BoomRow>& boom, const std::vector<ElasticRow>& elastic) {
  std::string text =
      "| machine | sensors | hull force z | stated: of revolutions, of constants | joint torque | stated | bending | "
      "stated |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const BoomRow& r : boom)
    text += "| " + r.machine + " | " + r.sensors + " |" + cells(r.life_force) + cells(r.life_torque) +
            cells(r.life_section) + "\n";
  for (const ElasticRow& r : elastic) {
    const LifeFigure &life = r.errors.life, &with_touch = r.errors.life_with_touch;
    if (r.level != Level::kRocker)
      text += format("| %s, level %s | none | %+.1f %%; with the touch %+.1f %% | %s | | | | |\n", r.machine.c_str(),
                     nameOf(r.level), 100.0 * life.error, 100.0 * with_touch.error, said(life).c_str());
  }
  return text +
         "| *others: towers of wind turbines, simulated* | | | | | | 5 to 10 % | |\n"
         "| *others: measured; corrected in the field* | | | | | | 10 to 15 %; below 5 % | |\n";
}

}  // namespace hammer_loads::accuracy
