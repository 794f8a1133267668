#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hammer_loads/bench/elastic_table.h"
#include "support/held_hull.h"

namespace hammer_loads::accuracy {
namespace {

/// Part of an estimate's samples, those during the touch aside, whose truth, a tenth of a millisecond away at most, is
/// within two deviations.
double covered(const ForceTrace& estimate, const ForceTrace& truth) {
  int within = 0, all = 0;
  for (std::size_t i = 0; i < estimate.time.size(); ++i) {
    if (std::abs(estimate.time[i]) < 2e-3) continue;
    const auto near = std::lower_bound(truth.time.begin(), truth.time.end(), estimate.time[i] - 5e-5);
    const double error = estimate.force_z[i] - truth.force_z[static_cast<std::size_t>(near - truth.time.begin())];
    within += std::abs(error) <= 2.0 * estimate.deviation[i] + 50.0;
    ++all;
  }
  return static_cast<double>(within) / all;
}

/// What the picture is to show: a ring of some kilonewtons, which linkage knows the size of and elastic follows.
TEST(BlowTrace, ShowsAVibrationThatOneLevelFollows) {
  const BlowTrace trace = blowTrace(test::heldHull(*load(configDirectory(), {}).value));
  EXPECT_EQ(trace.truth.time.size(), 501U);
  EXPECT_GE(trace.linkage.time.size(), 40U);
  EXPECT_GE(trace.elastic.time.size(), 40U);
  EXPECT_NEAR(trace.truth.time.front(), -0.005, 1e-9);
  const auto [least, most] = std::minmax_element(trace.truth.force_z.begin() + 100, trace.truth.force_z.end());
  EXPECT_LT(*least, -4000.0);
  EXPECT_GT(*most, 4000.0);
  EXPECT_GT(covered(trace.linkage, trace.truth), 0.85);
  EXPECT_GT(covered(trace.elastic, trace.truth), 0.85);
  const double widest = *std::max_element(trace.elastic.deviation.begin(), trace.elastic.deviation.end());
  EXPECT_LT(1.6 * widest, *std::max_element(trace.linkage.deviation.begin(), trace.linkage.deviation.end()));
}

}  // namespace
}  // namespace hammer_loads::accuracy
