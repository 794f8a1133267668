#include "hammer_loads/calibration/segment_fit.h"

#include <gtest/gtest.h>

#include "calibration/recorded.h"

namespace hammer_loads::calibration {
namespace {

/// The work of the torque, including drag and stiffness, equals the gain of energy.
TEST(BlowShot, TorquesWorkIsTheGainOfEnergy) {
  const Mechanism mechanism = test::mechanismOf(simulation::workingMo100());
  const ShaftModel model(mechanism, Level::kRocker);
  const HalfShot half{false, 14.0, {150, 160, 140, 170, 150}, 0.025, 0.6, {30.0, 14.0, 0.3}};
  std::vector<ShotPoint> points;
  std::vector<double> times;
  for (int i = 0; i <= 8000; ++i) times.push_back(1e-5 * i);
  shoot(model, half, times, points);
  const auto energy = [&](const ShotPoint& p) {
    return 0.5 * (0.6 + model({p.offset, Side::kAfterBlow}).inertia) * p.speed * p.speed;
  };
  const auto torque = [&](std::size_t i) {
    const double place = times[i] / 0.025, part = place - std::floor(place);
    const auto node = std::min(static_cast<int>(place), 3);
    const double walk = half.torque[node] +
                        (node == static_cast<int>(place) ? part : 1.0) * (half.torque[node + 1] - half.torque[node]);
    return walk + 14.0 * (30.0 * times[i] - points[i].offset) - 0.3 * (points[i].speed - 30.0);
  };
  double work = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    work += 0.5 * (torque(i) + torque(i - 1)) * (points[i].offset - points[i - 1].offset);
  EXPECT_NEAR(energy(points.back()) - energy(points.front()), work, 1e-4 * std::abs(work));
}

/// Compares the right-hand sides with finite differences of the cost.
TEST(SegmentFit, RightHandSidesAreTheCostsSlopes) {
  const simulation::MachineSettings s = test::atWork(3.0, 500.0);
  const Mechanism mechanism = test::mechanismOf(s);
  const SegmentModel model{mechanism, Level::kRocker};
  const std::vector<BlowSegment> segments = cutAtBlows(trackOf(test::recorded(s), 1.0), 0.0);
  ASSERT_GT(segments.size(), 3U);
  Globals globals;
  globals << 0.01, 0.01, -0.02, 0.005, 0.003, std::log(0.55), 5.0, 0.1;
  const Noise noise{0.02, true, 0.0, 2.0, 74.0, 295.0};  // wide: no residual is clipped, no deviation changes
  SegmentFit fit(segments[2], globals);
  const NormalEquations e = fit.linearise(model, globals, noise);
  const auto numeric = [&](auto move) {
    double sides[2];
    for (const int side : {0, 1}) {
      SegmentFit moved = fit;
      Globals at = globals;
      Locals locals = fit.locals();
      move(at, locals, side == 0 ? -1.0 : 1.0);
      moved.setLocals(locals);
      sides[side] = moved.cost(model, at, noise);
    }
    return 0.5 * (sides[1] - sides[0]);
  };
  Locals local_steps = Locals::Constant(0.3);
  local_steps.head<3>() << 1e-5, 1e-3, 1e-3;
  for (Eigen::Index k = 0; k < kLocals; ++k) {
    const double step = local_steps[k];
    const double slope = numeric([&](Globals&, Locals& l, double side) { l[k] += side * step; }) / step;
    EXPECT_NEAR(-e.l[k], slope, 2e-3 * std::abs(slope) + 2e-3 * std::sqrt(e.ll(k, k))) << k;
  }
  const double global_steps[] = {1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-3, 0.1, 0.01};
  for (Eigen::Index k = 0; k < kGlobals; ++k) {
    const double step = global_steps[k];
    const double slope = numeric([&](Globals& g, Locals&, double side) { g[k] += side * step; }) / step;
    EXPECT_NEAR(-e.g[k], slope, 2e-3 * std::abs(slope) + 2e-3 * std::sqrt(e.gg(k, k))) << k;
  }
}

}  // namespace
}  // namespace hammer_loads::calibration
