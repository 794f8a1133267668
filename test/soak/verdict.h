/// Results and requirements of a soak test: `key: value` lines and an exit code.
#pragma once

#include <cstdio>
#include <string>

namespace hammer_loads::soak {

class Verdict {
 public:
  void tell(const char* key, double value) { std::printf("%s: %.9g\n", key, value), std::fflush(stdout); }
  void demand(bool kept, const std::string& rule) {
    if (kept) return;
    std::fprintf(stderr, "violated: %s\n", rule.c_str());
    ++violations_;
  }
  int exitCode() const { return violations_ == 0 ? 0 : 1; }

 private:
  int violations_{};
};

}  // namespace hammer_loads::soak
