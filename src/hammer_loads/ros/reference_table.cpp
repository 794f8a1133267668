#include "hammer_loads/ros/reference_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>

#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

constexpr double kLatest = 4294967295.0;  // [s], largest stamp of a message
constexpr auto& kLoadNames = ReferenceComparison::kNames;

using Row = std::map<std::string, std::string>;  // cells by the names of their columns

/// Returns the load of a row; nothing if a cell is no number.
std::optional<MeasuredLoad> loadOf(Row row) {
  const auto stamp = decimalNumber(row["stamp"]);
  if (!stamp || !(*stamp >= 0.0 && *stamp <= kLatest)) return std::nullopt;
  MeasuredLoad measured;
  measured.stamp = std::llround(*stamp * 1e9);
  for (std::size_t i = 0; i < measured.load.size(); ++i) {
    const std::string& cell = row[kLoadNames[i]];
    const auto load = cell.empty() ? kNaN : decimalNumber(cell);
    if (!load || std::isinf(*load)) return std::nullopt;
    measured.load[i] = *load;
  }
  return measured;
}

}  // namespace

Checked<std::vector<MeasuredLoad>> readReferenceTable(const std::string& csv) {
  const auto problem = [](std::size_t line, const std::string& text) {
    return Checked<std::vector<MeasuredLoad>>{std::nullopt, {format("line %zu: ", line) + text}, {}};
  };
  std::vector<MeasuredLoad> rows;
  std::vector<std::string> header;
  std::size_t number = 0;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> cells = csvCells(line);
    const std::string quoted = "'" + line.substr(0, 60) + "', ";
    if (header.empty()) {
      header = cells;
      const auto named = [&](const char* name) { return std::count(header.begin(), header.end(), name) != 0; };
      if (!named("stamp") || std::none_of(std::begin(kLoadNames), std::end(kLoadNames), named))
        return problem(number, quoted + "must name stamp and at least one of force_x, force_z, torque_y");
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < std::min(header.size(), cells.size()); ++i) row.emplace(header[i], cells[i]);
    const auto measured = loadOf(std::move(row));
    if (!measured)
      return problem(number, quoted + "must have a stamp in seconds since 1970 and numbers in its columns");
    if (!rows.empty() && measured->stamp <= rows.back().stamp)
      return problem(number, quoted + "must be later than the line before");
    rows.push_back(*measured);
  }
  if (rows.empty()) return problem(number, "must hold a header and at least one row");
  return {std::move(rows), {}, {}};
}

}  // namespace hammer_loads
