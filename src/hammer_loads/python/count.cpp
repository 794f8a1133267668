#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/exact_cycles.h"
#include "hammer_loads/python/tables.h"

namespace hammer_loads::python {
namespace {

template <typename Counter>
void countAll(Counter& counter, const double* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) counter.add(values[i]);
}

}  // namespace

py::dict countCycles(const py::object& series, const std::optional<std::pair<double, double>>& full_scale,
                     std::int64_t classes) {
  const StateArrays values({{"series", series}});
  if (values.shape().size() > 1) raise({"series: has more than one dimension, must have one"});
  std::optional<life::LoadGrid> grid;
  if (full_scale) {
    const Checked<life::LoadGrid> made = life::LoadGrid::make(full_scale->first, full_scale->second, classes);
    if (!made.value) raise(made.problems);
    grid = made.value;
  }
  std::vector<life::RangeMean> cycles;
  {
    const py::gil_scoped_release others_may_run;
    std::vector<double> scratch;
    const double* first = values.count() > 0 ? values.from(0, 0, values.count(), scratch) : nullptr;
    if (grid) {
      life::CycleCounter counter(*grid);
      countAll(counter, first, values.count());
      cycles = life::rangesAndMeans(counter.take());
    } else {
      life::ExactCycles counter;
      countAll(counter, first, values.count());
      cycles = life::rangesAndMeans(counter);
    }
  }
  ResultArrays results({static_cast<py::ssize_t>(cycles.size())}, 3);
  double* range = results.add("range");
  double* mean = results.add("mean");
  double* count = results.add("count");
  for (std::size_t i = 0; i < cycles.size(); ++i)
    range[i] = cycles[i].range, mean[i] = cycles[i].mean, count[i] = cycles[i].count;
  return results.take();
}

}  // namespace hammer_loads::python
