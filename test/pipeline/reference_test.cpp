// Tests the comparison of a measured load with the computed one against hand calculations.
#include "hammer_loads/pipeline/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hammer_loads {
namespace {

constexpr StampNs kMillisecond = 1'000'000;
constexpr std::size_t kZ = 1;

/// Returns a force that is linear between whole milliseconds [N].
double forceAt(double milliseconds) {
  const double before = std::floor(milliseconds), part = milliseconds - before;
  const auto at = [](double t) { return 8000.0 * std::sin(0.03 * t) + 300.0; };
  return at(before) + part * (at(before + 1.0) - at(before));
}

HullWrench alongTool(double force) {
  HullWrench wrench{};
  wrench.force_z = force;
  return wrench;
}

TEST(Reference, FiguresAreThoseOfTheInterpolatedLoad) {
  ReferenceComparison comparison;
  std::vector<std::pair<double, double>> pairs;  // computed, measured
  const auto measure = [&](double milliseconds) {
    const double computed = forceAt(milliseconds);
    const double measured = 0.9 * computed - 120.0 + 50.0 * std::sin(7.0 * milliseconds);
    pairs.emplace_back(computed, measured);
    comparison.measured(static_cast<StampNs>(milliseconds * kMillisecond), {kNaN, measured, kNaN});
  };
  measure(0.0);
  for (int i = 0; i < 4000; ++i) {
    comparison.computed(i * kMillisecond, alongTool(forceAt(i)), alongTool(450.0), i > 0);
    if (i > 0 && i % 3 == 0) measure(i - 0.25);  // late
    if (i % 3 == 1) measure(i + 0.5);            // ahead: waits
  }
  comparison.computed(4000 * kMillisecond, alongTool(forceAt(4000)), alongTool(450.0), true);
  double n = 0.0, c = 0.0, m = 0.0, cm = 0.0, mm = 0.0, cc = 0.0, error = 0.0, within = 0.0;
  for (const auto& [computed, measured] : pairs) {
    n += 1.0, c += computed, m += measured, error += (computed - measured) * (computed - measured);
    within += std::abs(computed - measured) <= 900.0;
  }
  c /= n, m /= n;
  for (const auto& [computed, measured] : pairs)
    cm += (computed - c) * (measured - m), mm += (measured - m) * (measured - m), cc += (computed - c) * (computed - c);
  const ReferenceFigures z = comparison.figures(kZ);
  EXPECT_EQ(z.samples, pairs.size());
  EXPECT_EQ(comparison.leftOut(), 0U);
  EXPECT_NEAR(z.bias, c - m, 1e-8);
  EXPECT_NEAR(z.rms_error, std::sqrt(error / n), 1e-8);
  EXPECT_NEAR(z.scale, cm / mm, 1e-12);
  EXPECT_NEAR(z.correlation, cm / std::sqrt(mm * cc), 1e-12);
  EXPECT_NEAR(z.within_two_std, within / n, 1e-12);
  EXPECT_GT(within, 0.0);
  EXPECT_LT(within, n);
  EXPECT_EQ(comparison.figures(0).samples, 0U) << "not measured";
}

TEST(Reference, BlowsGapsAndWhatComesTooLateAreLeftOut) {
  ReferenceComparison comparison;
  comparison.measured(0, {0.0, 0.0, 0.0});
  comparison.computed(0, alongTool(0.0), {}, false);
  comparison.computed(10 * kMillisecond, alongTool(1000.0), {}, false);  // a gap, or a blow
  comparison.measured(5 * kMillisecond, {0.0, 1e9, 0.0});
  EXPECT_EQ(comparison.figures(kZ).samples, 1U);
  EXPECT_EQ(comparison.leftOut(), 1U);
  for (int i = 11; i < 1200; ++i) comparison.computed(i * kMillisecond, alongTool(1000.0), {}, true);
  comparison.measured(20 * kMillisecond, {0.0, 1e9, 0.0});
  EXPECT_EQ(comparison.leftOut(), 2U) << "1180 samples late";
  comparison.measured(500 * kMillisecond, {0.0, 1000.0, 0.0});
  EXPECT_EQ(comparison.figures(kZ).samples, 2U);
  EXPECT_EQ(comparison.figures(kZ).rms_error, 0.0);
}

}  // namespace
}  // namespace hammer_loads
