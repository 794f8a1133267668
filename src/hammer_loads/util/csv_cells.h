/// Lines of CSV files.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace hammer_loads {

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
