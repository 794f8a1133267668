/// Progress bar of a slow command.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "hammer_loads/util/format.h"

namespace hammer_loads {

/// Time as 1:23:45 or 2:07; rounded up, so that it is not over before 0:00.
inline std::string timeText(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole >= 3600) return format("%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return format("%ld:%02ld", whole / 60, whole % 60);
}

/// Drawn on a terminal only: once per percent, and once a second while a percent takes longer. The remaining time is
/// extrapolated from the elapsed one; not for the first 2 %, which are little information.
class ProgressBar {
 public:
  void operator()(double part) {
    const int percent = static_cast<int>(100.0 * part);
    const Clock::time_point now = Clock::now();
    if (!terminal_ || last_ >= 100 || (percent == last_ && now - drawn_ < std::chrono::seconds(1))) return;
    last_ = percent;
    drawn_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    std::string time;
    if (percent >= 2) time = "  " + timeText(seconds * (1.0 - part) / part) + " left";
    if (percent >= 100) time = "  " + timeText(seconds);
    std::fprintf(stderr, "\r[%-50.*s] %3d %%%s\033[K%s", percent / 2,
                 "##################################################", percent, time.c_str(),
                 percent >= 100 ? "\n" : "");
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_{isatty(STDERR_FILENO) == 1};
  int last_{-1};
  Clock::time_point start_{Clock::now()}, drawn_{};
};

}  // namespace hammer_loads
