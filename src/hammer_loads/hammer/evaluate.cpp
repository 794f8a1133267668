#include "hammer_loads/hammer/evaluate.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <sstream>

#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

enum StateColumn : std::size_t { kAngle, kSpeed, kAcceleration, kPitch, kGravity };
constexpr std::size_t kStates = kStateColumns.size();
constexpr std::array<const char*, kStates> kRules{"rad, must be a finite number of size <= 1e15",
                                                  "rad/s, must be a finite number", "rad/s2, must be a finite number",
                                                  "rad, must be a finite number", "m/s2, must be a finite number >= 0"};
constexpr std::array<const char*, 7> kMotionAndWrenchColumns{
    "rocker_angle_rad", "rod_angle_rad",  "rocker_speed_rad_s", "rocker_accel_rad_s2",
    "hull_force_x_N",   "hull_force_z_N", "hull_torque_y_Nm"};
constexpr std::size_t kPins = kMotionAndWrenchColumns.size();  ///< index of the first result of the pins
constexpr std::size_t kResults = kPins + kPinColumns.size();

using Cells = std::vector<std::string>;
using Places = std::array<std::size_t, kStates>;  ///< position of each of kStateColumns in a row
using Problems = std::vector<std::string>;

bool isBlank(const Cells& cells) { return cells.size() == 1 && cells[0].empty(); }

/// Text on one line, shortened when long.
std::string shown(const std::string& cell) {
  constexpr std::size_t kLongest = 60;
  if (cell.empty()) return "(empty)";
  return onOneLine(cell.size() > kLongest ? cell.substr(0, kLongest) + "..." : cell);
}

std::optional<double> numberFromText(const std::string& text) {
  const std::optional<double> number = decimalNumber(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

Places placesOf(const Cells& header, Problems& problems) {
  Places places{};
  for (std::size_t c = 0; c < kStates; ++c) {
    const auto found = std::count(header.begin(), header.end(), kStateColumns[c]);
    places[c] = static_cast<std::size_t>(std::find(header.begin(), header.end(), kStateColumns[c]) - header.begin());
    if (found == 0) problems.push_back(format("header: %s: is required, not found", kStateColumns[c]));
    if (found > 1) problems.push_back(format("header: %s: found %td times, must be once", kStateColumns[c], found));
  }
  return places;
}

std::array<double, kResults> resultsOf(const HullModel& model, const CrankMotion& crank, Gravity gravity) noexcept {
  const Evaluation e = evaluate(model, crank, gravity);
  std::array<double, kResults> results{e.rocker_angle,   e.rod_angle,      e.rocker_speed,   e.rocker_acceleration,
                                       e.wrench.force_x, e.wrench.force_z, e.wrench.torque_y};
  const auto pins = pinValues(e.pins);
  std::copy(pins.begin(), pins.end(), results.begin() + kPins);
  return results;
}

struct EvaluatedRow {
  std::string given;  ///< cells of kStateColumns
  std::array<double, kResults> results;
};

/// Adds a line for each bad cell of a row `place`, else for its first bad result.
void evaluateRow(const HullModel& model, const Cells& all, const Places& places, const std::string& place,
                 std::vector<EvaluatedRow>& rows, Problems& problems) {
  const std::size_t problems_before = problems.size();
  const std::optional<CrankAngle> angle = crankAngleFromText(all[places[kAngle]]);
  std::array<double, kStates> numbers{};
  std::string given;
  for (std::size_t c = 0; c < kStates; ++c) {
    const std::string& cell = all[places[c]];
    const std::optional<double> number = numberFromText(cell);
    const bool allowed = c == kAngle ? angle.has_value() : number && !(c == kGravity && *number < 0.0);
    if (!allowed) problems.push_back(place + kStateColumns[c] + ": " + shown(cell) + ' ' + kRules[c]);
    numbers[c] = number.value_or(0.0);
    given += (c == 0 ? "" : ",") + cell;
  }
  if (problems.size() > problems_before) return;
  const Gravity gravity{numbers[kGravity] * std::sin(numbers[kPitch]), -numbers[kGravity] * std::cos(numbers[kPitch])};
  rows.push_back({given, resultsOf(model, {*angle, numbers[kSpeed], numbers[kAcceleration]}, gravity)});
  const auto& results = rows.back().results;
  for (std::size_t i = 0; i < kResults; ++i) {
    // A pin's force may be infinite at the blow; an overflow shows in the drive torque, the first of the pins.
    if (std::isfinite(results[i]) || (i > kPins && std::isnan(results[i]))) continue;
    const char* column = i < kPins ? kMotionAndWrenchColumns[i] : kPinColumns[i - kPins];
    return problems.push_back(place + column + format(": %g, must be finite: the state is too large", results[i]));
  }
}

void write(const std::vector<EvaluatedRow>& rows, std::ostream& out) {
  std::string header;
  for (const char* column : kStateColumns) header += (header.empty() ? "" : ",") + std::string(column);
  for (const char* column : kMotionAndWrenchColumns) header += "," + std::string(column);
  for (const char* column : kPinColumns) header += "," + std::string(column);
  out << header << '\n';
  for (const EvaluatedRow& row : rows) {
    out << row.given;
    for (const double result : row.results) out << format(",%.17g", result + 0.0);  // no minus before a zero
    out << '\n';
    if (!out) break;
  }
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

std::optional<CrankAngle> crankAngleFromText(const std::string& text) {
  using Extended = boost::multiprecision::cpp_dec_float_50;
  constexpr double kLargestAngle = 1e15;  // [rad]: beyond it 50 digits no longer hold a double's worth of offset
  constexpr double kHalfTurn = 3.14159265358979;
  constexpr int kMostDecimals = 40;
  const std::optional<double> nearest = numberFromText(text);
  if (!nearest || std::abs(*nearest) > kLargestAngle) return std::nullopt;
  if (std::abs(*nearest) < kHalfTurn) return CrankAngle::fromOffset(*nearest);
  static const Extended two_pi = boost::math::constants::two_pi<Extended>();
  const Extended angle(text);
  const Extended blow = round(angle / two_pi) * two_pi;
  Extended written = blow;
  const std::string mantissa = text.substr(0, text.find_first_of("eE"));
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  const auto digitsFrom = [&](std::size_t at) {
    return at > mantissa.size() ? 0 : std::count_if(mantissa.begin() + static_cast<long>(at), mantissa.end(), isDigit);
  };
  if (digitsFrom(mantissa.find_first_of("123456789")) > std::numeric_limits<double>::max_digits10) {
    const int exponent = mantissa.size() < text.size() ? std::atoi(text.c_str() + mantissa.size() + 1) : 0;
    const int decimals = static_cast<int>(digitsFrom(mantissa.find('.'))) - exponent;
    written = Extended(blow.str(std::clamp(decimals, 0, kMostDecimals), std::ios::fixed));
  }
  CrankAngle result = CrankAngle::fromOffset(static_cast<double>(angle - written));
  if (result.offset == 0.0 && angle < blow) result.side = Side::kBeforeBlow;
  return result;
}

std::vector<std::string> evaluateTable(const HullModel& model, std::istream& in, std::ostream& out) {
  constexpr std::size_t kMostProblems = 20;
  std::string line;
  std::getline(in, line);
  if (isBlank(csvCells(line))) return {"header: missing, must be a line with the names of the columns"};
  if (line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);  // mark of UTF-8
  const Cells header = csvCells(line);
  Problems problems;
  const Places places = placesOf(header, problems);
  if (!problems.empty()) return problems;
  std::vector<EvaluatedRow> rows;
  for (std::size_t row = 1; std::getline(in, line); ++row) {
    const Cells cells = csvCells(line);
    if (isBlank(cells)) continue;
    if (cells.size() == header.size())
      evaluateRow(model, cells, places, format("row %zu: ", row), rows, problems);
    else
      problems.push_back(format("row %zu: %zu cells, must be %zu as in the header", row, cells.size(), header.size()));
  }
  if (in.bad()) problems.emplace_back("input: cannot be read to its end");
  if (problems.empty()) write(rows, out);
  if (problems.size() <= kMostProblems) return problems;
  const std::size_t left_out = problems.size() - (kMostProblems - 1);
  problems.resize(kMostProblems - 1);
  problems.push_back(format("and %zu more", left_out));
  return problems;
}

}  // namespace hammer_loads
