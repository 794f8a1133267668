#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <random>

#include "hammer_loads/linkage/crank_motion.h"

namespace hammer_loads {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

Exact nearestBlow(double phi) {
  const Exact two_pi = 2 * boost::math::constants::pi<Exact>();
  const Exact turns = floor(Exact(phi) / two_pi + Exact(0.5));
  return Exact(phi) - turns * two_pi;
}

TEST(CrankAngle, OffsetIsExactWithinTheFirstTurns) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-30.0, 30.0);
  for (int i = 0; i < 20000; ++i) {
    const double phi = angle(random);
    const Exact exact = nearestBlow(phi);
    const double wrapped = CrankAngle::wrapToPi(phi);
    EXPECT_LE(abs(Exact(wrapped) - exact), 2.3e-16 * abs(exact) + 1e-30) << phi;
  }
}

TEST(CrankAngle, OffsetKeepsItsDigitsNextToTheBlow) {
  const double two_pi = 6.283185307179586232;
  for (double turns = -5.0; turns <= 5.0; ++turns) {
    for (double distance = 1e-1; distance > 1e-15; distance *= 0.1) {
      for (double sign : {-1.0, 1.0}) {
        const double phi = turns * two_pi + sign * distance;
        const Exact exact = nearestBlow(phi);
        EXPECT_LE(abs(Exact(CrankAngle::wrapToPi(phi)) - exact), 2.3e-16 * abs(exact) + 1e-30) << phi;
      }
    }
  }
}

TEST(CrankAngle, ManyTurnsCostNoMoreThanTheAnglesOwnRounding) {
  std::mt19937 random(2);
  for (double turns : {1e3, 1e6, 1e9}) {
    std::uniform_real_distribution<double> angle(-turns * 6.28, turns * 6.28);
    for (int i = 0; i < 5000; ++i) {
      const double phi = angle(random);
      // The fma rounds once at the size of the offset. The third part of 2 pi adds 6e-33 per revolution.
      const double bound = 4.5e-16 + turns * 6.1e-33 * 10;
      EXPECT_LE(abs(Exact(CrankAngle::wrapToPi(phi)) - nearestBlow(phi)), bound) << phi;
    }
  }
}

TEST(CrankAngle, SideFollowsTheOffsetAndTheBlowItselfIsAfter) {
  EXPECT_EQ(CrankAngle::fromAngle(0.0).side, Side::kAfterBlow);
  EXPECT_EQ(CrankAngle::fromAngle(-0.0).side, Side::kAfterBlow);
  EXPECT_EQ(CrankAngle::fromAngle(1e-300).side, Side::kAfterBlow);
  EXPECT_EQ(CrankAngle::fromAngle(-1e-300).side, Side::kBeforeBlow);
  EXPECT_EQ(CrankAngle::fromAngle(3.0).side, Side::kAfterBlow);
  EXPECT_EQ(CrankAngle::fromAngle(3.3).side, Side::kBeforeBlow);
  EXPECT_EQ(CrankAngle::fromAngle(-3.3).side, Side::kAfterBlow);
  EXPECT_EQ(CrankAngle::fromAngle(6.2).side, Side::kBeforeBlow);
  EXPECT_EQ(CrankAngle::fromAngle(6.3).side, Side::kAfterBlow);
}

}  // namespace
}  // namespace hammer_loads
