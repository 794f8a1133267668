#include "hammer_loads/hammer/state_table.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <cstdlib>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

enum Column : std::size_t { kAngle, kSpeed, kAcceleration, kPitch, kGravity };

constexpr std::array<const char*, kStateColumns.size()> kUnits{"rad", "rad/s", "rad/s2", "rad", "m/s2"};
constexpr std::array<const char*, kStateColumns.size()> kRules{
    "a finite number of size <= 1e15", "a finite number", "a finite number", "a finite number", "a finite number >= 0"};
constexpr double kLargestAngle = 1e15;  // [rad]: beyond it 50 digits no longer hold a double's worth of offset
constexpr int kDigitsOfDouble = 17;
constexpr int kMostDecimals = 40;

using Cells = std::vector<std::string>;

Cells split(const std::string& line) {
  Cells cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::size_t first = std::min(line.find_first_not_of(" \t\r", begin), end);
    std::size_t last = end;
    while (last > first && std::string(" \t\r").find(line[last - 1]) != std::string::npos) --last;
    cells.push_back(line.substr(first, last - first));
    begin = end + 1;
  }
  return cells;
}

bool isBlank(const std::string& line) { return line.find_first_not_of(" \t\r") == std::string::npos; }

/// On one line, shortened when long.
std::string shown(const std::string& cell) {
  constexpr std::size_t kLongest = 60;
  std::string text = cell.size() > kLongest ? cell.substr(0, kLongest) + "..." : cell;
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text.empty() ? "(empty)" : text;
}

/// strtod would also take hexadecimal digits and names.
std::optional<double> numberFromText(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

struct Digits {
  int significant;
  int decimals;  ///< of them below one, at most kMostDecimals
};

Digits digitsOf(const std::string& number) {
  const std::string mantissa = number.substr(0, number.find_first_of("eE"));
  const int exponent = mantissa.size() < number.size() ? std::atoi(number.c_str() + mantissa.size() + 1) : 0;
  Digits digits{0, -exponent};
  bool below_one = false;
  for (const char c : mantissa) {
    if (c == '.') below_one = true;
    if (c < '0' || c > '9') continue;
    if (c != '0' || digits.significant > 0) ++digits.significant;
    if (below_one) ++digits.decimals;
  }
  digits.decimals = std::clamp(digits.decimals, 0, kMostDecimals);
  return digits;
}

using Places = std::array<std::size_t, kStateColumns.size()>;

/// Where the header has each of kStateColumns.
Places placesOf(const Cells& header, std::vector<std::string>& problems) {
  Places places{};
  for (std::size_t c = 0; c < kStateColumns.size(); ++c) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] == kStateColumns[c]) places[c] = i, ++found;
    }
    if (found == 0) problems.push_back(format("header: %s: is required, not found", kStateColumns[c]));
    if (found > 1) problems.push_back(format("header: %s: found %zu times, must be once", kStateColumns[c], found));
  }
  return places;
}

std::optional<TableState> stateOf(const Cells& cells, std::size_t row, std::vector<std::string>& problems) {
  std::array<double, kStateColumns.size()> numbers{};
  const std::optional<CrankAngle> angle = crankAngleFromText(cells[kAngle]);
  bool good = true;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::optional<double> number = numberFromText(cells[c]);
    const bool allowed = c == kAngle ? angle.has_value() : number && !(c == kGravity && *number < 0.0);
    if (allowed) numbers[c] = number.value_or(0.0);
    if (!allowed) {
      problems.push_back(format("row %zu: %s: %s %s, must be %s", row, kStateColumns[c], shown(cells[c]).c_str(),
                                kUnits[c], kRules[c]));
    }
    good = good && allowed;
  }
  if (!good) return std::nullopt;
  const double g = numbers[kGravity], pitch = numbers[kPitch];
  TableState state{
      {*angle, numbers[kSpeed], numbers[kAcceleration]}, {g * std::sin(pitch), -g * std::cos(pitch)}, {}, row};
  for (const std::string& cell : cells) state.text += (state.text.empty() ? "" : ",") + cell;
  return state;
}

}  // namespace

std::optional<CrankAngle> crankAngleFromText(const std::string& text) {
  using Extended = boost::multiprecision::cpp_dec_float_50;
  constexpr double kHalfTurn = 3.14159265358979;
  const std::optional<double> nearest = numberFromText(text);
  if (!nearest || std::abs(*nearest) > kLargestAngle) return std::nullopt;
  if (std::abs(*nearest) < kHalfTurn) return CrankAngle::fromOffset(*nearest);
  static const Extended two_pi = boost::math::constants::two_pi<Extended>();
  const Extended angle(text);
  const Extended blow = round(angle / two_pi) * two_pi;
  const Extended exact = angle - blow;
  const Digits digits = digitsOf(text);
  const Extended written =
      digits.significant > kDigitsOfDouble ? Extended(blow.str(digits.decimals, std::ios::fixed)) : blow;
  CrankAngle result = CrankAngle::fromOffset(static_cast<double>(angle - written));
  if (result.offset == 0.0 && exact < 0) result.side = Side::kBeforeBlow;
  return result;
}

Checked<std::vector<TableState>> readStates(std::istream& in) {
  Checked<std::vector<TableState>> result;
  std::string line;
  if (!std::getline(in, line) || isBlank(line)) {
    result.problems.emplace_back("header: missing, must be a line with the names of the columns");
    return result;
  }
  if (line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);  // mark of UTF-8
  const std::size_t width = split(line).size();
  const Places places = placesOf(split(line), result.problems);
  if (!result.problems.empty()) return result;

  std::vector<TableState> states;
  for (std::size_t row = 1; std::getline(in, line); ++row) {
    if (isBlank(line)) continue;
    const Cells all = split(line);
    if (all.size() != width) {
      result.problems.push_back(format("row %zu: %zu cells, must be %zu as in the header", row, all.size(), width));
      continue;
    }
    Cells cells;
    for (const std::size_t place : places) cells.push_back(all[place]);
    if (std::optional<TableState> state = stateOf(cells, row, result.problems)) states.push_back(std::move(*state));
  }
  if (in.bad()) result.problems.emplace_back("input: cannot be read to its end");
  result.problems = shortened(std::move(result.problems), 20);
  if (result.problems.empty()) result.value = std::move(states);
  return result;
}

std::vector<std::string> shortened(std::vector<std::string> lines, std::size_t most) {
  if (lines.size() <= most) return lines;
  const std::size_t left_out = lines.size() - (most - 1);
  lines.resize(most - 1);
  lines.push_back(format("and %zu more", left_out));
  return lines;
}

}  // namespace hammer_loads
