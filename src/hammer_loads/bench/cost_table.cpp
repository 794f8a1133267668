#include "hammer_loads/bench/cost_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hammer_loads/bench/grapple_costs.h"
#include "hammer_loads/bench/life_costs.h"
#include "hammer_loads/bench/load_costs.h"
#include "hammer_loads/bench/step_costs.h"
#include "hammer_loads/settings/read_grapple.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

Error worstOf(const CostRow& row) {
  Error worst;
  for (const CaseError& c : row.errors) {
    worst.of_peak = std::max(worst.of_peak, c.error.of_peak);
    worst.relative = std::max(worst.relative, c.error.relative);
  }
  return worst;
}

bool isLoad(const CostRow& row) { return row.group == "printed" || row.group == "scalar" || row.group == "batch"; }

std::string shown(double error) { return std::isfinite(error) ? format("%.1e", error) : "no number"; }

std::string costCells(const CostRow& row) {
  return format("| %s | %s | %.1f | %.0f %% | %.3g million |", row.group.c_str(), row.name.c_str(), row.cost.median,
                100.0 * row.cost.spread, 1e3 / row.cost.median);
}

std::string loadTable(const std::vector<CostRow>& rows) {
  std::string text =
      "| | way to the loads | ns | spread | per second and core | left out | worst error of the peak | worst relative "
      "error |\n|---|---|---|---|---|---|---|---|\n";
  for (const CostRow& row : rows) {
    if (!isLoad(row)) continue;
    const Error worst = worstOf(row);
    text += costCells(row) + format(" %.2g %% | %s | %s |\n", *row.left_out < 1e-9 ? 0.0 : 100.0 * *row.left_out,
                                    shown(worst.of_peak).c_str(), shown(worst.relative).c_str());
  }
  return text;
}

std::string stepTable(const std::vector<CostRow>& rows) {
  std::string text = "| | step | ns | spread | per second and core |\n|---|---|---|---|---|\n";
  for (const CostRow& row : rows) {
    if (!isLoad(row)) text += costCells(row) + "\n";
  }
  return text;
}

/// Rows whose errors are of the same cases as those of `first`.
template <typename Wanted>
std::string caseTable(const std::vector<CostRow>& rows, double Error::*kind, const Wanted& wanted) {
  std::string head, rule, text;
  for (const CostRow& row : rows) {
    if (!wanted(row) || row.errors.empty()) continue;
    if (head.empty()) {
      head = "| | |", rule = "|---|---|";
      for (const CaseError& c : row.errors) head += ' ' + c.name + " |", rule += "---|";
    }
    text += "| " + row.group + " | " + row.name + " |";
    for (const CaseError& c : row.errors) text += ' ' + shown(c.error.*kind) + " |";
    text += '\n';
  }
  return head + '\n' + rule + '\n' + text;
}

}  // namespace

std::vector<CostRow> costTable(const Settings& settings) {
  const Checked<Grapple> grapple = loadGrapple({configDirectory() + "/grapple_claims.yaml"});
  if (!grapple.value) throw std::runtime_error(grapple.problems.front());
  std::vector<CostRow> rows = loadCosts(settings.mechanism);
  for (const std::vector<CostRow>& more : {stepCosts(settings), lifeCosts(), grappleCosts(*grapple.value)})
    rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

std::string markdown(const std::vector<CostRow>& rows) {
  const auto is_grapple = [](const CostRow& row) { return row.group == "grapple"; };
  return "### Loads of one state\n\n" + loadTable(rows) + "\n### One sample\n\n" + stepTable(rows) +
         "\n### Worst error of the peak by case\n\n" + caseTable(rows, &Error::of_peak, isLoad) +
         "\n### Worst relative error by case\n\n" + caseTable(rows, &Error::relative, isLoad) +
         "\n### Worst relative error of the grapple\n\n" + caseTable(rows, &Error::relative, is_grapple);
}

std::string json(const std::vector<CostRow>& rows) {
  std::string text = "[";
  for (const CostRow& row : rows) {
    text += format("%s\n  {\"group\": \"%s\", \"name\": \"%s\", \"ns\": %.5g, \"spread\": %.3g, \"per_second\": %.5g, ",
                   &row == rows.data() ? "" : ",", row.group.c_str(), row.name.c_str(), row.cost.median,
                   row.cost.spread, 1e9 / row.cost.median);
    text += "\"left_out\": " + (row.left_out ? jsonNumber(*row.left_out) : "null") + ", \"errors\": {";
    for (const CaseError& c : row.errors) {
      text += format("%s\n    \"%s\": {\"of_peak\": %s, \"relative\": %s}", &c == row.errors.data() ? "" : ",",
                     c.name.c_str(), jsonNumber(c.error.of_peak).c_str(), jsonNumber(c.error.relative).c_str());
    }
    text += "}}";
  }
  return text + "\n]";
}

}  // namespace hammer_loads::accuracy
