// Bounds of a boom's description and cylinders, within a factor of 1.25 of what is said; deviations where a file gives
// none.
#include <gtest/gtest.h>

#include <cmath>

#include "boom/booms.h"
#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/cylinder_flags.h"
#include "hammer_loads/boom/urdf_limits.h"
#include "hammer_loads/boom/vibration_spread.h"

namespace hammer_loads {
namespace {

std::string repeated(const std::string& text, double count) {
  std::string all;
  for (int i = 0; i < std::lround(count); ++i) all += text;
  return all;
}

class BoomBounds : public testing::Test {
 protected:
  BoomBounds()
      : chain_(*Chain::make(test::shippedUrdf(), {}).value),
        cylinder_(*Cylinder::make(test::shippedBoomParameters().cylinders.front(), 1e9, chain_).value) {}

  const Chain chain_;
  const Cylinder cylinder_;
};

TEST_F(BoomBounds, OfDescriptions) {
  const auto isTooLong = [](const std::string& text) { return !urdfLimitPassed(text).empty(); };
  for (const double part : {0.8, 1.25}) {
    const bool beyond = part > 1.0;
    EXPECT_EQ(isTooLong(std::string(static_cast<std::size_t>(part * 16.0 * 1024.0 * 1024.0), ' ')), beyond);
    EXPECT_EQ(isTooLong(repeated("<a>", part * 64.0)), beyond);
    EXPECT_EQ(isTooLong("<robot>" + repeated("<link/>", part * 1000.0)), beyond);
    EXPECT_EQ(isTooLong("<robot>" + repeated("<joint/>", part * 1000.0)), beyond);
  }
}

/// The load takes from the chamber without pressure until its oil parts.
TEST_F(BoomBounds, OfVacuum) {
  const CylinderPosition at = cylinder_.at(-0.5);
  ASSERT_FALSE(at.dead_centre);
  const auto leastPressure = [&](double torque) {
    const ChamberPressures p = chamberPressures(cylinder_, at, 0.0, torque);
    return std::min(p.bore, p.rod);
  };
  const double per_torque = leastPressure(1.0);
  for (const double part : {0.8, 1.25}) {
    const std::uint16_t flags = cylinderFlags(cylinder_, at, 0.0, -part * 1e5 / per_torque);
    EXPECT_EQ((flags & kChamberEmpty) != 0, part > 1.0);
  }
}

/// Arm over the shorter of the distances of the two pins from the joint's axis.
TEST_F(BoomBounds, OfADeadCentre) {
  const CylinderParameters& p = cylinder_.parameters();
  const Eigen::Vector3d origin = chain_.link(chain_.linkBeyond(cylinder_.joint())).origin;
  const double shorter =
      std::min(std::hypot(p.base_x - origin.x(), p.base_z - origin.z()), std::hypot(p.rod_x, p.rod_z));
  int near = 0, beside = 0;
  for (double q = -3.2; q < 3.2; q += 1e-4) {
    const CylinderPosition at = cylinder_.at(q);
    const double ratio = std::abs(at.arm) / shorter;
    near += ratio<0.8 * 0.02, beside += ratio> 1.25 * 0.02;
    EXPECT_FALSE(ratio < 0.8 * 0.02 && !at.dead_centre) << q;
    EXPECT_FALSE(ratio > 1.25 * 0.02 && at.dead_centre) << q;
  }
  EXPECT_GT(near, 10);
  EXPECT_GT(beside, 10);
}

/// As the tables of doc/parameters.md and doc/boom.md have them.
TEST_F(BoomBounds, DeviationsWhereAFileGivesNone) {
  const BoomParameters boom;
  EXPECT_EQ(boom.link_mass_deviation, 0.03);
  EXPECT_EQ(boom.link_com_deviation, 0.02);
  EXPECT_EQ(CylinderParameters::kFrictionDeviation, 0.03);
  EXPECT_EQ(CylinderParameters::kStiffnessDeviation, 0.1);
  const OilDeviation oil;
  EXPECT_NEAR(oil.frequency, 0.5 * 0.3, 1e-12) << "of a bulk modulus known to 30 %";
  EXPECT_NEAR(std::exp(oil.damping), 1.6, 0.1);
}

}  // namespace
}  // namespace hammer_loads
