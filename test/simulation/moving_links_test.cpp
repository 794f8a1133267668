#include "hammer_loads/simulation/moving_links.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr Gravity kTilted{0.8, -9.7};

/// Returns an MO-100 with plausible masses of crank and rod.
HammerParameters heavy() {
  HammerParameters p = workingMo100().hammer;
  p.crank_mass = 6.0;
  p.crank_com_along = 0.01;
  p.crank_com_across = 0.004;
  p.crank_inertia_about_com = 0.02;
  p.rod_mass = 9.0;
  p.rod_com_along = 0.07;
  p.rod_com_across = -0.003;
  p.rod_inertia_about_com = 0.03;
  return p;
}

MovingLinks make(const HammerParameters& p, Level level) { return {*Mechanism::make(p).value, level}; }

/// Returns angles within the revolution (0, 2 pi) and close to both of its ends.
std::vector<TurnAngle> angles() {
  std::vector<TurnAngle> all{{0.0, false}, {0.0, true}};
  for (int i = 1; i < 72; ++i) {
    const double phi = i * kPi / 36.0;
    all.push_back(phi <= kPi ? TurnAngle{phi, false} : TurnAngle{phi - 2.0 * kPi, true});
  }
  for (double tiny = 1e-2; tiny > 1e-14; tiny *= 0.1) {
    all.push_back({tiny, false});
    all.push_back({-tiny, true});
  }
  return all;
}

TEST(MovingLinks, LoadAgreesWithHullWrench) {
  const HammerParameters p = workingMo100().hammer;
  const Mechanism mechanism = *Mechanism::make(p).value;
  const MovingLinks links(mechanism, Level::kRocker);
  for (const TurnAngle angle : angles()) {
    const CrankAngle crank{angle.offset, angle.before_blow ? Side::kBeforeBlow : Side::kAfterBlow};
    const HullWrench wrench = hullWrench(mechanism, Level::kRocker, {crank, 40.0, -600.0}, kTilted);
    const Load load = links.load(links.at(angle), 40.0, -600.0, kTilted);
    EXPECT_NEAR(load.force_x, wrench.force_x, 1e-8) << angle.offset;
    EXPECT_NEAR(load.force_z, wrench.force_z, 1e-8) << angle.offset;
    EXPECT_NEAR(load.torque_y, wrench.torque_y, 1e-9) << angle.offset;
  }
}

TEST(MovingLinks, ShaftAgreesWithShaftLoad) {
  const Mechanism mechanism = *Mechanism::make(workingMo100().hammer).value;
  const MovingLinks links(mechanism, Level::kRocker);
  for (const TurnAngle angle : angles()) {
    const CrankAngle crank{angle.offset, angle.before_blow ? Side::kBeforeBlow : Side::kAfterBlow};
    const ShaftLoad load = shaftLoadRocker(mechanism, motion(mechanism.linkage(), crank), kTilted);
    const ShaftView view = links.shaft(links.at(angle), kTilted);
    EXPECT_NEAR(view.inertia, load.inertia, 1e-12) << angle.offset;
    EXPECT_NEAR(0.5 * view.inertia_slope, load.half_inertia_slope, 1e-11) << angle.offset;
    EXPECT_NEAR(view.weight_torque, load.weight_torque, 1e-11) << angle.offset;
  }
}

/// Lagrange's equation of the shaft must follow from energy: without weight, the power of the drive torque is the rate
/// of the kinetic energy.
TEST(MovingLinks, ShaftEquationFollowsFromEnergy) {
  const MovingLinks links = make(heavy(), Level::kLinkage);
  const double w = 25.0, e = 300.0, dt = 1e-6;
  for (double phi = 0.3; phi < 3.0; phi += 0.37) {
    const auto kinetic = [&](double t) {
      const double speed = w + e * t;
      return 0.5 * links.shaft(links.at({phi + w * t + 0.5 * e * t * t, false}), {}).inertia * speed * speed;
    };
    const ShaftView view = links.shaft(links.at({phi, false}), {});
    EXPECT_NEAR((kinetic(dt) - kinetic(-dt)) / (2.0 * dt), (view.inertia * e + 0.5 * view.inertia_slope * w * w) * w,
                2e-3);
  }
}

}  // namespace
}  // namespace hammer_loads::simulation
