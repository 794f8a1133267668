/// Numbers and cells from text, texts that read back as the same number, texts on one line.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/util/format.h"

namespace hammer_loads {

/// Without line breaks and other control characters.
inline std::string onOneLine(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

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

/// Cells of a line without the spaces around them; one empty cell for a blank line.
inline std::vector<std::string> csvCells(const std::string& line) {
  constexpr char kSpaces[] = " \t\r";
  std::vector<std::string> cells;
  std::istringstream rest(line + ',');  // the last cell may be empty
  for (std::string cell; std::getline(rest, cell, ',');) {
    cell.erase(0, std::min(cell.find_first_not_of(kSpaces), cell.size()));
    cell.erase(cell.find_last_not_of(kSpaces) + 1);
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace hammer_loads
