/// Numbers from text.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace hammer_loads {

/// A decimal number that is the whole text; strtod would also take hexadecimal digits and names. Overflow is infinite.
inline std::optional<double> decimalNumber(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) return std::nullopt;
  return number;
}

}  // namespace hammer_loads
