#include "hammer_loads/ros/reference_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

constexpr double kLatest = 4294967295.0;  // [s], as a message's stamp

using Cells = std::vector<std::string>;

/// Places of the columns in a line.
struct Columns {
  std::size_t stamp{};
  std::array<std::optional<std::size_t>, ReferenceComparison::kComponents> load;
};

std::optional<Columns> columnsOf(const Cells& header) {
  const auto place = [&](const char* name) -> std::optional<std::size_t> {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.begin());
  };
  Columns columns;
  bool any = false;
  for (std::size_t i = 0; i < columns.load.size(); ++i)
    any = (columns.load[i] = place(ReferenceComparison::kNames[i])).has_value() || any;
  const auto stamp = place("stamp");
  if (!stamp || !any) return std::nullopt;
  columns.stamp = *stamp;
  return columns;
}

/// Reads a row. Nothing: a cell is no number.
std::optional<MeasuredLoad> rowOf(const Cells& cells, const Columns& columns) {
  if (columns.stamp >= cells.size()) return std::nullopt;
  const auto stamp = decimalNumber(cells[columns.stamp]);
  if (!stamp || !(*stamp >= 0.0 && *stamp <= kLatest)) return std::nullopt;
  MeasuredLoad row;
  row.stamp = std::llround(*stamp * 1e9);
  for (std::size_t i = 0; i < row.load.size(); ++i) {
    row.load[i] = kNaN;
    if (!columns.load[i] || *columns.load[i] >= cells.size() || cells[*columns.load[i]].empty()) continue;
    const auto load = decimalNumber(cells[*columns.load[i]]);
    if (!load || !std::isfinite(*load)) return std::nullopt;
    row.load[i] = *load;
  }
  return row;
}

}  // namespace

Checked<std::vector<MeasuredLoad>> readReferenceTable(const std::string& csv) {
  const auto problem = [](std::size_t line, const std::string& text) {
    return Checked<std::vector<MeasuredLoad>>{std::nullopt, {format("line %zu: ", line) + text}, {}};
  };
  std::vector<MeasuredLoad> rows;
  std::optional<Columns> columns;
  std::size_t number = 0;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const Cells cells = csvCells(line);
    const std::string quoted = "'" + line.substr(0, 60) + "', ";
    if (!columns) {
      columns = columnsOf(cells);
      if (!columns) return problem(number, quoted + "must name stamp and at least one of force_x, force_z, torque_y");
      continue;
    }
    const auto row = rowOf(cells, *columns);
    if (!row) return problem(number, quoted + "must have a stamp in seconds since 1970 and numbers in its columns");
    if (!rows.empty() && row->stamp <= rows.back().stamp)
      return problem(number, quoted + "must be later than the line before");
    rows.push_back(*row);
  }
  if (rows.empty()) return problem(number, "must hold a header and at least one row");
  Checked<std::vector<MeasuredLoad>> result;
  result.value.emplace(std::move(rows));
  return result;
}

}  // namespace hammer_loads
