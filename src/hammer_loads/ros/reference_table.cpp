#include "hammer_loads/ros/reference_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

constexpr double kLatest = 4294967295.0;  // [s], as a message's stamp

std::vector<std::string_view> fieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    field.remove_prefix(std::min(field.find_first_not_of(' '), field.size()));
    field.remove_suffix(field.size() - std::min(field.find_last_not_of(' ') + 1, field.size()));
    fields.push_back(field);
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

/// Places of the columns in a line.
struct Columns {
  std::size_t stamp{};
  std::array<std::optional<std::size_t>, ReferenceComparison::kComponents> load;
};

std::optional<Columns> columnsOf(const std::vector<std::string_view>& header) {
  const auto place = [&](std::string_view name) -> std::optional<std::size_t> {
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

/// Nothing: a field is no number.
std::optional<MeasuredLoad> rowOf(const std::vector<std::string_view>& fields, const Columns& columns) {
  if (columns.stamp >= fields.size()) return std::nullopt;
  const auto stamp = decimalNumber(std::string(fields[columns.stamp]));
  if (!stamp || !(*stamp >= 0.0 && *stamp <= kLatest)) return std::nullopt;
  MeasuredLoad row;
  row.stamp = std::llround(*stamp * 1e9);
  for (std::size_t i = 0; i < row.load.size(); ++i) {
    row.load[i] = kNaN;
    if (!columns.load[i] || *columns.load[i] >= fields.size() || fields[*columns.load[i]].empty()) continue;
    const auto load = decimalNumber(std::string(fields[*columns.load[i]]));
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
  for (std::string_view rest = csv; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = fieldsOf(line);
    const std::string quoted = "'" + std::string(line.substr(0, 60)) + "', ";
    if (!columns) {
      columns = columnsOf(fields);
      if (!columns) return problem(number, quoted + "must name stamp and at least one of force_x, force_z, torque_y");
      continue;
    }
    const auto row = rowOf(fields, *columns);
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
