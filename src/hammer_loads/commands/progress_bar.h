/// Progress of a command that takes longer than a blink.
#pragma once

#include <unistd.h>

#include <cstdio>

namespace hammer_loads {

/// Drawn on a terminal only, once per percent.
class ProgressBar {
 public:
  void operator()(double part) {
    const int percent = static_cast<int>(100.0 * part);
    if (!terminal_ || percent == last_) return;
    last_ = percent;
    std::fprintf(stderr, "\r[%-50.*s] %3d %%%s", percent / 2, "##################################################",
                 percent, percent == 100 ? "\n" : "");
  }

 private:
  bool terminal_{isatty(STDERR_FILENO) == 1};
  int last_{-1};
};

}  // namespace hammer_loads
