/// Numbers from text, and texts that read back as the same number.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "hammer_loads/util/format.h"

namespace hammer_loads {

/// A decimal number that is the whole text; strtod would also take hexadecimal digits and names. Overflow is infinite.
inline std::optional<double> decimalNumber(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) return std::nullopt;
  return number;
}

/// Shortest of at most 17 significant digits that reads back as the same double.
inline std::string shortNumber(double value) {
  std::string text;
  for (int digits = 15; digits <= 17; ++digits) {
    text = format("%.*g", digits, value);
    if (std::strtod(text.c_str(), nullptr) == value) break;
  }
  return text;
}

}  // namespace hammer_loads
