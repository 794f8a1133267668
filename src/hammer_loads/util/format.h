/// printf into a std::string, for one-line reports.
#pragma once

#include <cstdio>
#include <string>

namespace hammer_loads {

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

}  // namespace hammer_loads
