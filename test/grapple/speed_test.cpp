/// Cost of one step: time and heap allocations.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "grapple/grapples.h"
#include "hammer_loads/grapple/branches.h"
#include "hammer_loads/grapple/grapple_tracker.h"
#include "support/wall_clock.h"

namespace hammer_loads {
namespace {

/// Returns the median over batches of the time per call [ns].
template <typename Call>
double medianTime(int batches, int calls, const Call& call) {
  std::vector<double> times;
  for (int i = 0; i < batches; ++i) {
    const auto start = std::chrono::steady_clock::now();
    for (int j = 0; j < calls; ++j) call(i * calls + j);
    times.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / calls);
  }
  std::nth_element(times.begin(), times.begin() + batches / 2, times.end());
  return times[static_cast<std::size_t>(batches / 2)];
}

/// Returns a slider that moves over the stroke and back, 2000 samples per cycle (2 s at 1 kHz).
std::vector<double> swing(const GrappleParameters& p) {
  std::vector<double> sliders;
  const double middle = 0.5 * (p.slider_closed + p.slider_open), half = 0.5 * (p.slider_open - p.slider_closed);
  for (int i = 0; i < 2000; ++i) sliders.push_back(middle + half * std::cos(2.0 * kPi * i / 2000.0));
  return sliders;
}

constexpr double kWarmLimit = 300.0, kColdLimit = 20000.0;  // [ns], required

TEST(Speed, StaysBelowItsBoundInAWarmStepOfBothJaws) {
  for (const GrappleParameters& p : {test::claimsParameters(), test::straightParameters()}) {
    GrappleTracker tracker(test::grappleOf(p));
    const std::vector<double> sliders = swing(p);
    double sum = 0.0;
    const double step = medianTime(60, 2000, [&](int i) {
      tracker.update({sliders[static_cast<std::size_t>(i) % sliders.size()], 0.3, -0.2});
      sum += tracker.motion().p.re;
    });
    const double with_jaws = medianTime(60, 2000, [&](int i) {
      tracker.update({sliders[static_cast<std::size_t>(i) % sliders.size()], 0.3, -0.2});
      sum += tracker.right().edge_acceleration.re + tracker.left().edge_acceleration.re;
    });
    std::printf("warm step: %.0f ns; with both jaws in time: %.0f ns (%g)\n", step, with_jaws, sum);
    EXPECT_EQ(tracker.refused(), 0u);
    test::expectTimeWithin(with_jaws, kWarmLimit, "[ns] a warm step with both jaws");
  }
}

TEST(Speed, StaysBelowItsBoundInAColdEnumeration) {
  const GrappleParameters p = test::claimsParameters();
  const Grapple grapple = test::grappleOf(p);
  const std::vector<double> sliders = swing(p);
  double sum = 0.0;
  const double two_modes = medianTime(100, 100, [&](int i) {
    const double slider = sliders[static_cast<std::size_t>(i * 37) % sliders.size()];
    if (const auto m = grapple.at(slider)) sum += m->p.re;
  });
  const GrappleParameters six = test::sixModeLinkage();
  const LeverGroup group(six);
  const double six_modes = medianTime(
      100, 100, [&](int i) { sum += enumerateBranches(group, six.o1 + six.o1a * direction(0.4 + 1e-6 * i)).count; });
  std::printf("cold pose, two modes: %.1f us; enumeration of six modes: %.1f us (%g)\n", 1e-3 * two_modes,
              1e-3 * six_modes, sum);
  test::expectTimeWithin(two_modes, kColdLimit, "[ns] a cold pose");
  test::expectTimeWithin(six_modes, kColdLimit, "[ns] enumeration of six modes");
}

}  // namespace
}  // namespace hammer_loads
