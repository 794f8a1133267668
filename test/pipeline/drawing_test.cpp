// A machine that differs from its nominal parameters: the standard deviations must cover the difference.
#include <gtest/gtest.h>

#include "hammer_loads/bench/drawing_table.h"
#include "support/held_hull.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

TEST(Drawing, ErrorsOfMachinesDrawnFromItAreWithinTheDeviations) {
  Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  settings.pipeline.level = Level::kLinkage;
  HammerParameters parameters = settings.mechanism.parameters();
  // The drawn machines have no joint clearance, pin friction or rod damping that acts after a blow.
  parameters.rod_std.play = parameters.rod_std.friction_radius = parameters.rod_std.damping_ratio = 0.0;
  settings.mechanism = test::mechanismOf(parameters);
  double covered[3]{}, energy = 0.0, impulse = 0.0, amplitude = 0.0;
  int ranges = 0, low = 0;
  constexpr int kDrawings = 12;
  for (int i = 0; i < kDrawings; ++i) {
    const accuracy::DrawingRow row = accuracy::drawingRow(settings, 901 + static_cast<std::uint64_t>(i));
    for (int k = 0; k < 3; ++k) {
      const double part = row.samples[static_cast<std::size_t>(k)].covered;
      low += part < 0.75;
      covered[k] += part / kDrawings;
    }
    energy += row.energy.covered / kDrawings;
    impulse += row.impulse.covered / kDrawings;
    amplitude += row.amplitude.covered / kDrawings;
    ranges += row.range.covered > 0.5;
  }
  for (const double part : covered) {
    EXPECT_GT(part, 0.88);
    EXPECT_LT(part, 0.995);  // the deviations are not too large either
  }
  // A machine's errors are alike in all its revolutions, so that one in six may exceed two standard deviations.
  EXPECT_LE(low, kDrawings / 6);
  for (const double part : {energy, impulse, amplitude}) EXPECT_GT(part, 0.8);
  EXPECT_GE(ranges, kDrawings - 1);
}

}  // namespace
}  // namespace hammer_loads
