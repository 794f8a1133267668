#include "hammer_loads/life/load_grid.h"

#include "hammer_loads/util/format.h"

namespace hammer_loads::life {

Checked<LoadGrid> LoadGrid::make(double least, double greatest, std::int64_t classes) {
  Checked<LoadGrid> result;
  const double span = greatest - least;
  if (!(std::isfinite(span) && span > 0.0))
    result.problems.push_back(
        format("full scale: %.17g to %.17g, must be finite and the first below the second", least, greatest));
  if (classes < 2 || classes > kMostClasses)
    result.problems.push_back(format("classes: %lld, must be an integer in [2, %u]", static_cast<long long>(classes),
                                     static_cast<unsigned>(kMostClasses)));
  if (!result.problems.empty()) return result;
  const LoadGrid grid(least, greatest, static_cast<std::uint32_t>(classes));
  // Else neighbouring classes would have the same centre, or the width could not be inverted.
  const bool distinct = grid.level(0) < grid.level(1) && grid.level(grid.classes_ - 2) < grid.level(grid.classes_ - 1);
  if (!distinct || !std::isfinite(grid.per_width_)) {
    result.problems.push_back(
        format("full scale: %.17g to %.17g, must be wide enough for %u classes", least, greatest, grid.classes_));
    return result;
  }
  result.value = grid;
  return result;
}

}  // namespace hammer_loads::life
