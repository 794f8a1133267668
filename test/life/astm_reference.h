/// Rainflow count as worded in ASTM E1049-85, 5.4.4 (three points, moving start point), and lists of cycles.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "hammer_loads/life/cycle_counter.h"
#include "support/count_text.h"

namespace hammer_loads::life::test {

using Series = std::vector<double>;
using Cycles = std::map<std::pair<double, double>, double>;  ///< (range, mean) -> count
using Ranges = std::map<double, double>;                     ///< range -> count

inline Series turningPoints(const Series& series) {
  Series points;
  for (const double value : series) {
    if (!points.empty() && points.back() == value) continue;
    const std::size_t n = points.size();
    if (n >= 2 && (points[n - 1] - points[n - 2]) * (value - points[n - 1]) > 0.0) points.pop_back();
    points.push_back(value);
  }
  return points;
}

inline Cycles astmCount(const Series& series) {
  Cycles cycles;
  const auto count = [&](double a, double b, double n) { cycles[{std::abs(a - b), 0.5 * (a + b)}] += n; };
  Series open;  // points not discarded, the start point S first
  for (const double point : turningPoints(series)) {
    open.push_back(point);
    while (open.size() >= 3) {
      const std::size_t n = open.size();
      const double x = std::abs(open[n - 1] - open[n - 2]), y = std::abs(open[n - 2] - open[n - 3]);
      if (x < y) break;
      if (n == 3) {  // Y contains S: half a cycle, S moves on
        count(open[0], open[1], 0.5);
        open.erase(open.begin());
      } else {
        count(open[n - 3], open[n - 2], 1.0);
        open.erase(open.end() - 3, open.end() - 1);
      }
    }
  }
  for (std::size_t i = 1; i < open.size(); ++i) count(open[i - 1], open[i], 0.5);
  return cycles;
}

inline Cycles cyclesOf(const std::vector<RangeMean>& list) {
  Cycles cycles;
  for (const RangeMean& c : list) cycles[{c.range, c.mean}] += c.count;
  return cycles;
}

inline Ranges rangesOf(const Cycles& cycles) {
  Ranges ranges;
  for (const auto& [cycle, count] : cycles) ranges[cycle.first] += count;
  return ranges;
}

inline ExactCycles exactCount(const Series& series) {
  ExactCycles count;
  for (const double value : series) count.add(value);
  return count;
}

inline CycleCount gridCount(const Series& series, const LoadGrid& grid) {
  CycleCounter counter(grid);
  for (const double value : series) counter.add(value);
  return counter.take();
}

/// Returns a grid with classes centred on the integers from least to greatest, so that such a series keeps its values.
inline LoadGrid integerGrid(int least, int greatest) {
  return LoadGrid::make(least - 0.5, greatest + 0.5, greatest - least + 1).value.value();
}

inline Series randomIntegers(std::mt19937& random, std::size_t size, int least, int greatest) {
  std::uniform_int_distribution<int> value(least, greatest);
  Series series(size);
  std::generate(series.begin(), series.end(), [&] { return value(random); });
  return series;
}

}  // namespace hammer_loads::life::test
