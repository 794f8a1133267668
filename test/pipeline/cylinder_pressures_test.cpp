#include "hammer_loads/pipeline/cylinder_pressures.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;

TEST(CylinderPressures, NeedBothChambers) {
  CylinderPressures pressures(0.02);
  EXPECT_TRUE(pressures.update(kMs, 1, Chamber::kBore, 5e6));
  EXPECT_FALSE(pressures.at(1, kMs));
  EXPECT_TRUE(pressures.update(kMs, 1, Chamber::kRod, 1e6));
  ASSERT_TRUE(pressures.at(1, kMs));
  EXPECT_EQ(pressures.at(1, kMs)->bore, 5e6);
  EXPECT_FALSE(pressures.at(0, kMs)) << "another cylinder";
  EXPECT_FALSE(pressures.at(1, 30 * kMs)) << "too old";
}

TEST(CylinderPressures, LieOnTheLineThroughTheLastTwo) {
  CylinderPressures pressures(0.02);
  for (const StampNs t : {kMs, 3 * kMs}) {
    pressures.update(t, 0, Chamber::kBore, 1e6 * static_cast<double>(t / kMs));
    pressures.update(t, 0, Chamber::kRod, 2e6);
  }
  EXPECT_NEAR(pressures.at(0, 2 * kMs)->bore, 2e6, 1e-6);
  EXPECT_NEAR(pressures.at(0, 4 * kMs)->bore, 4e6, 1e-6);
  EXPECT_NEAR(pressures.at(0, 9 * kMs)->bore, 5e6, 1e-6) << "one interval beyond at most";
}

TEST(CylinderPressures, RefuseWhatCannotBeAndGoOn) {
  CylinderPressures pressures(0.02);
  EXPECT_TRUE(pressures.update(10 * kMs, 0, Chamber::kBore, 5e6));
  EXPECT_FALSE(pressures.update(11 * kMs, 0, Chamber::kBore, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(pressures.update(11 * kMs, 0, Chamber::kBore, 1e9));
  EXPECT_FALSE(pressures.update(9 * kMs, 0, Chamber::kBore, 5e6)) << "late";
  EXPECT_EQ(pressures.refused(), 3U);
  EXPECT_TRUE(pressures.update(12 * kMs, 0, Chamber::kBore, 6e6));
  EXPECT_FALSE(pressures.update(1 * kMs, 0, Chamber::kBore, 5e6));
  EXPECT_TRUE(pressures.update(2 * kMs, 0, Chamber::kBore, 5e6)) << "time that runs back is believed the second time";
  EXPECT_EQ(pressures.accepted(), 3U);
}

}  // namespace
}  // namespace hammer_loads
