/// Text for one-line reports: printf into a std::string, names in a row.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace hammer_loads {

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

/// With commas between them.
inline std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace hammer_loads
