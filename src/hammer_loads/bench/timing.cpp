#include "hammer_loads/bench/timing.h"

#include <time.h>

#include <algorithm>
#include <vector>

namespace hammer_loads::accuracy {
namespace {

/// Processor time of this thread [ns]: other programs on the machine do not count.
double threadTime() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double timeOf(std::size_t passes, const std::function<void()>& pass) {
  const double start = threadTime();
  for (std::size_t i = 0; i < passes; ++i) pass();
  return threadTime() - start;
}

struct Repeat {
  std::size_t passes;
  double time;  // of all its passes [ns]
};

/// Long enough to be timed. Also warms up.
Repeat repeatOf(const std::function<void()>& pass) {
  Repeat repeat{1, timeOf(1, pass)};
  while (repeat.time < kLeastRepeat) {
    repeat.passes *= 2;
    repeat.time = timeOf(repeat.passes, pass);
  }
  return repeat;
}

}  // namespace

Cost costOf(std::size_t evaluations, const std::function<void()>& pass) {
  const Repeat repeat = repeatOf(pass);
  const int repeats = std::clamp(static_cast<int>(kTogether / repeat.time), kLeastRepeats, kMostRepeats);
  for (int i = 0; i < std::min(kWarmUps, repeats / 3); ++i) timeOf(repeat.passes, pass);
  std::vector<double> times(static_cast<std::size_t>(repeats));
  for (double& time : times) {
    time = timeOf(repeat.passes, pass) / (static_cast<double>(repeat.passes) * static_cast<double>(evaluations));
  }
  std::sort(times.begin(), times.end());
  const auto quarter = [&](std::size_t i) { return times[i * times.size() / 4]; };
  return {quarter(2), (quarter(3) - quarter(1)) / quarter(2)};
}

}  // namespace hammer_loads::accuracy
