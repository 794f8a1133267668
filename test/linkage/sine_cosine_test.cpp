#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

TEST(HalfAngleSine, PolynomialsAreExactToRounding) {
  double worst_sine = 0.0, worst_cosine = 0.0;
  for (int i = -16600; i <= 16600; ++i) {
    const double h = kPolynomialAngle * i / 16600.0;
    const SineCosine got = sineCosinePolynomial(h);
    if (i != 0) worst_sine = std::max(worst_sine, static_cast<double>(abs(Exact(got.sine) / sin(Exact(h)) - 1)));
    worst_cosine = std::max(worst_cosine, static_cast<double>(abs(Exact(got.cosine) - cos(Exact(h)))));
  }
  EXPECT_LE(worst_sine, 3e-16);
  EXPECT_LE(worst_cosine, 3e-16);
}

TEST(HalfAngleSine, ServesAnyAngle) {
  for (double h : {-100.0, -2.0, -1.66, 1.5, 1.67, 3.0, 1e6}) {
    EXPECT_NEAR(sineCosine(h).sine, std::sin(h), 3e-16);
    EXPECT_NEAR(sineCosine(h).cosine, std::cos(h), 3e-16);
  }
}

}  // namespace
}  // namespace hammer_loads
