/// The output of grapple_table: rows of the jaw edge's path, or its design figures.
#pragma once

#include <optional>
#include <ostream>
#include <string>

#include "hammer_loads/grapple/design_figures.h"

namespace hammer_loads {

struct TableRequest {
  std::optional<double> from;     ///< slider position of the first row [m]; without it the closed one
  std::optional<double> to;       ///< slider position of the last row [m]; by default the open one
  std::optional<double> opening;  ///< instead: one row, where the jaw edges are this far apart [m]
  int steps{};                    ///< >= 1; equidistant, one row more than that
  bool summary{};                 ///< figures of the path between from and to instead of rows
};

/// Prints rows with 17 significant digits, or `key: value` lines with 12. Returns nothing, or one line that gives the
/// reason; then nothing has been printed unless a row in the middle failed.
std::optional<std::string> printTable(const Grapple& grapple, const TableRequest& request, std::ostream& out);

}  // namespace hammer_loads
