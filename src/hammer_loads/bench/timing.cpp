#include "hammer_loads/bench/timing.h"

#include <time.h>

#include <algorithm>
#include <array>

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

/// Also warms up.
std::size_t passesPerRepeat(const std::function<void()>& pass) {
  std::size_t passes = 1;
  while (timeOf(passes, pass) < kLeastRepeat) passes *= 2;
  return passes;
}

}  // namespace

Cost costOf(std::size_t evaluations, const std::function<void()>& pass) {
  const std::size_t passes = passesPerRepeat(pass);
  for (int i = 0; i < kWarmUps; ++i) timeOf(passes, pass);
  std::array<double, kRepeats> times{};
  for (double& time : times) time = timeOf(passes, pass) / static_cast<double>(passes * evaluations);
  std::sort(times.begin(), times.end());
  const double median = times[kRepeats / 2];
  return {median, (times[3 * kRepeats / 4] - times[kRepeats / 4]) / median};
}

}  // namespace hammer_loads::accuracy
