// A machine with absurd parameters is refused with reasons, or all its results are finite.
#include <gtest/gtest.h>

#include <limits>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/linkage/pin_forces.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "property/draw.h"

namespace hammer_loads {
namespace {

using test::Draw;
using test::kMachines;

template <typename... Values>
bool allFinite(Values... values) {
  return (std::isfinite(values) && ...);
}

/// Returns true if all results of a mechanism at a state of the crank are finite.
bool isFinite(const Mechanism& mechanism, Level level, const CrankMotion& crank, Gravity gravity) {
  const HullWrench w = hullWrench(mechanism, level, crank, gravity);
  const LinkMomentum m = linkMomentum(mechanism, level, crank.angle, crank.speed);
  const ShaftLoad s = shaftLoad(mechanism, level, crank.angle, gravity);
  const PinReactions p = pinForces(mechanism, level, crank, gravity, NearBlow(0.01));
  const RockerBlow b = blowAtCrankSpeed(mechanism, level, std::abs(crank.speed) + 1.0);
  return allFinite(w.force_x, w.force_z, w.torque_y, m.x, m.z, m.about_d) &&
         allFinite(s.inertia, s.half_inertia_slope, s.weight_torque, s.weight_torque_slope) &&
         allFinite(p.hull_on_crank.x, p.hull_on_crank.z, p.crank_on_rod.x, p.crank_on_rod.z, p.rod_on_rocker.x,
                   p.rod_on_rocker.z, p.hull_on_rocker.x, p.hull_on_rocker.z, p.drive_torque) &&
         allFinite(b.rocker_speed_before, b.rocker_speed_after, b.restitution, b.energy, b.friction_work,
                   b.tool_impulse_x, b.tool_impulse_z, b.support_impulse_x, b.support_impulse_z);
}

/// Returns a random field: any constant of the hammer file, or the inertia of the drive.
double& garbled(HammerParameters& p, Draw& draw) {
  const std::size_t which = draw.index(kHammerConstants.size() + 1);
  return which < kHammerConstants.size() ? kHammerConstants[which].field(p) : p.drive_inertia;
}

/// Replaces one to three fields of a valid machine by garbage; some lengths still meet the change-point condition.
HammerParameters garbage(Draw& draw) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  constexpr double kValues[] = {kNan,  kInf,   -kInf,  1e308,  -1e308, 1e300,  1e200,   1e155, 1e100, 1e30, 1e12, 1e-12,
                                1e-30, 1e-100, 1e-160, 1e-200, 1e-300, 5e-324, -5e-324, 0.0,   -0.0,  1.0,  -1.0, 57.3};
  HammerParameters p = draw.parameters();
  const std::size_t changes = 1 + draw.index(3);
  for (std::size_t k = 0; k < changes; ++k) garbled(p, draw) = kValues[draw.index(std::size(kValues))];
  if (draw.index(2) == 0) p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  if (draw.index(4) == 0)
    p.rocker_inertia_about_pivot = 2.0 * p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance;
  if (draw.index(8) == 0) {
    const double scale = std::pow(10.0, draw.between(-320.0, 308.0));
    p.lengths = {p.lengths.crank * scale, p.lengths.rod * scale, p.lengths.rocker * scale,
                 p.lengths.pivot_distance * scale};
  }
  return p;
}

TEST(RandomMachines, GarbageIsRefusedWithReasonsOrGivesFiniteLoads) {
  Draw draw(5);
  int refused = 0, accepted = 0;
  for (int i = 0; i < kMachines; ++i) {
    const Checked<Mechanism> made = Mechanism::make(garbage(draw));
    if (!made.value) {
      ++refused;
      ASSERT_FALSE(made.problems.empty()) << i;
      for (const std::string& problem : made.problems) {
        ASSERT_NE(problem.find(": "), std::string::npos) << problem;
        ASSERT_NE(problem.find("must be"), std::string::npos) << problem;
        ASSERT_EQ(problem.find('\n'), std::string::npos) << problem;
      }
      continue;
    }
    ++accepted;
    CrankMotion crank = draw.crank();
    crank.angle.offset = std::copysign(std::max(1e-6, std::abs(crank.angle.offset)), crank.angle.offset);
    for (const Level level : {Level::kRocker, Level::kLinkage})
      ASSERT_TRUE(isFinite(*made.value, level, crank, draw.gravity())) << i;
  }
  EXPECT_GT(refused, kMachines / 4);
  EXPECT_GT(accepted, kMachines / 10);
}

}  // namespace
}  // namespace hammer_loads
