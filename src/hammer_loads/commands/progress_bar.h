/// Progress bar of a slow command.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace hammer_loads {

/// Time as 1:23:45 or 2:07; rounded up, so that it is not over before 0:00.
inline std::string timeText(double seconds) {
  const auto whole = static_cast<long>(seconds) + (seconds > static_cast<double>(static_cast<long>(seconds)) ? 1 : 0);
  char text[48];
  if (whole >= 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

/// Line of the bar with the remaining time, extrapolated from the elapsed one; not for the first 2 %, which are little
/// information.
inline std::string progressLine(double part, double seconds_so_far) {
  const int percent = static_cast<int>(100.0 * part);
  char text[80];
  std::snprintf(text, sizeof text, "[%-50.*s] %3d %%", percent / 2,
                "##################################################", percent);
  std::string line = text;
  if (percent < 2) return line;
  if (percent >= 100) return line + "  " + timeText(seconds_so_far);
  return line + "  " + timeText(seconds_so_far * (1.0 - part) / part) + " left";
}

/// Drawn on a terminal only: once per percent, and once a second while a percent takes longer.
class ProgressBar {
 public:
  void operator()(double part) {
    const int percent = static_cast<int>(100.0 * part);
    if (!terminal_ || last_ >= 100) return;
    const Clock::time_point now = Clock::now();
    if (percent == last_ && now - drawn_ < std::chrono::seconds(1)) return;
    last_ = percent;
    drawn_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "\r%s\033[K%s", progressLine(part, seconds).c_str(), percent >= 100 ? "\n" : "");
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_{isatty(STDERR_FILENO) == 1};
  int last_{-1};
  Clock::time_point start_{Clock::now()}, drawn_{};
};

}  // namespace hammer_loads
