/// Text for one-line reports: printf into a std::string, names in a row.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace hammer_loads {

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  const int size = std::snprintf(nullptr, 0, pattern, args...);
  std::string text(static_cast<std::size_t>(std::max(0, size)), '\0');
  std::snprintf(text.data(), text.size() + 1, pattern, args...);
  return text;
}

/// Four digits; null where there is none.
inline std::string jsonNumber(double value) { return std::isfinite(value) ? format("%.4g", value) : "null"; }

/// Joins texts, such as a std::vector or std::set of names, with `between` as separator.
template <typename Texts>
std::string joined(const Texts& texts, const char* between = ", ") {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + text;
  return all;
}

}  // namespace hammer_loads
