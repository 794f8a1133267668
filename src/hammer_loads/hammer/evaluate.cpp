#include "hammer_loads/hammer/evaluate.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/hammer/state_table.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr std::array<const char*, 7> kMotionAndWrenchColumns{
    "rocker_angle_rad", "rod_angle_rad",  "rocker_speed_rad_s", "rocker_accel_rad_s2",
    "hull_force_x_N",   "hull_force_z_N", "hull_torque_y_Nm"};
constexpr std::size_t kResults = kMotionAndWrenchColumns.size() + kPinColumns.size();

const char* resultColumn(std::size_t i) {
  return i < kMotionAndWrenchColumns.size() ? kMotionAndWrenchColumns[i]
                                            : kPinColumns[i - kMotionAndWrenchColumns.size()];
}

std::array<double, kResults> resultsOf(const HullModel& model, const TableState& state) noexcept {
  const Evaluation e = evaluate(model, state.crank, state.gravity);
  std::array<double, kResults> results{e.rocker_angle,   e.rod_angle,      e.rocker_speed,   e.rocker_acceleration,
                                       e.wrench.force_x, e.wrench.force_z, e.wrench.torque_y};
  const auto pins = pinValues(e.pins);
  std::copy(pins.begin(), pins.end(), results.begin() + kMotionAndWrenchColumns.size());
  return results;
}

/// A pin's force may have no limit at the blow; what is too large has no finite drive torque, the first of the pins.
bool isGood(const std::array<double, kResults>& results, std::size_t i) noexcept {
  return std::isfinite(results[i]) || (i > kMotionAndWrenchColumns.size() && std::isnan(results[i]));
}

std::vector<std::string> problemsOf(const HullModel& model, const std::vector<TableState>& states) {
  std::vector<std::string> problems;
  for (const TableState& state : states) {
    const auto results = resultsOf(model, state);
    std::size_t bad = 0;
    while (bad < kResults && isGood(results, bad)) ++bad;
    if (bad == kResults) continue;
    problems.push_back(
        format("row %zu: %s: %g, must be finite: the state is too large", state.row, resultColumn(bad), results[bad]));
  }
  return shortened(std::move(problems), 20);
}

std::string headerLine() {
  std::string line;
  for (const char* column : kStateColumns) line += (line.empty() ? "" : ",") + std::string(column);
  for (std::size_t i = 0; i < kResults; ++i) line += "," + std::string(resultColumn(i));
  return line;
}

}  // namespace

Evaluation evaluate(const HullModel& model, const CrankMotion& crank, Gravity gravity) noexcept {
  const LinkMotion links = linkMotion(model.mechanism().linkage(), crank.angle);
  const Motion& rocker = links.rocker;
  Evaluation result;
  result.rocker_angle = rockerAngle(rocker);
  result.rod_angle = rodAngle(links);
  result.rocker_speed = rocker.u * crank.speed;
  result.rocker_acceleration = rocker.du * crank.speed * crank.speed + rocker.u * crank.acceleration;
  result.wrench = hullWrench(model, crank, gravity);
  result.pins = pinForces(model.mechanism(), model.level(), crank, gravity, NearBlow(0.0));
  return result;
}

std::array<double, kPinColumns.size()> pinValues(const PinReactions& p) noexcept {
  std::array<double, kPinColumns.size()> values{p.drive_torque,    p.hull_on_crank.x,  p.hull_on_crank.z,
                                                p.crank_on_rod.x,  p.crank_on_rod.z,   p.rod_on_rocker.x,
                                                p.rod_on_rocker.z, p.hull_on_rocker.x, p.hull_on_rocker.z};
  for (double& value : values) value = std::isnan(value) ? std::abs(value) : value;  // no minus before a nan
  return values;
}

std::vector<std::string> evaluateTable(const HullModel& model, std::istream& in, std::ostream& out) {
  const Checked<std::vector<TableState>> states = readStates(in);
  if (!states.value) return states.problems;
  std::vector<std::string> problems = problemsOf(model, *states.value);
  if (!problems.empty()) return problems;
  out << headerLine() << '\n';
  for (const TableState& state : *states.value) {
    out << state.text;
    for (const double result : resultsOf(model, state))
      out << format(",%.17g", result + 0.0);  // + 0.0: no minus before a zero
    out << '\n';
    if (!out) break;
  }
  return {};
}

}  // namespace hammer_loads
