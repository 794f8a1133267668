#include "hammer_loads/grapple/slider_drive.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "grapple/grapples.h"

namespace hammer_loads {
namespace {

using Digits100 = boost::multiprecision::cpp_bin_float_100;

/// Returns theta_H by the law of cosines as in the paper, to 100 digits.
Digits100 directionOfH(const GrappleParameters& p, const Digits100& slider) {
  const Digits100 gx = Digits100(p.slider_x) - p.o1.re, gy = slider - p.o1.im;
  const Digits100 distance = sqrt(gx * gx + gy * gy), r(p.o1h), l(p.gh);
  return atan2(gy, gx) + p.drive_sign * acos((r * r + distance * distance - l * l) / (2 * distance * r));
}

struct Exact {
  Digits100 angle, first, second;
};

/// Uses central differences with a step of 1e-20: error some 1e-40 relative to the fourth derivative.
Exact exactDrive(const GrappleParameters& p, double slider) {
  const Digits100 step("1e-20"), s(slider);
  const Digits100 before = directionOfH(p, s - step), now = directionOfH(p, s), after = directionOfH(p, s + step);
  return {now, (after - before) / (2 * step), (after - 2 * now + before) / (step * step)};
}

TEST(SliderDrive, EqualsTheLawOfCosinesToHundredDigits) {
  test::Random random(11);
  double worst_angle = 0.0, worst_first = 0.0, worst_second = 0.0;
  for (int i = 0; i < 300; ++i) {
    const GrappleParameters p = test::randomLinkage(random);
    const SliderDrive drive(p);
    const double slider = p.o1.im + random(-2.5, 2.5);
    const auto m = drive.at(slider);
    if (!m) continue;
    const Exact exact = exactDrive(p, slider);
    const Digits100 sine = (sin(exact.angle) * m->o1h.re - cos(exact.angle) * m->o1h.im) / p.o1h;
    const auto relative = [](double value, const Digits100& truth) {
      return static_cast<double>(abs(value - truth) / (1 + abs(truth)));
    };
    // Rounding of |O1G| and of sums of the four lengths moves a flat triangle by 1e-16 over its height.
    const auto reach = drive.reachAround(slider);
    ASSERT_TRUE(reach);
    const double from_dead_centre = std::min(slider - reach->low, reach->high - slider);
    const double amplification = 1.0 + 1.0 / from_dead_centre;
    worst_angle = std::max(worst_angle, static_cast<double>(abs(sine)) / amplification);
    worst_first = std::max(worst_first, relative(m->dtheta1, exact.first) / amplification);
    worst_second = std::max(worst_second, relative(m->ddtheta1, exact.second) / amplification);
  }
  EXPECT_LT(worst_angle, 1e-15);
  EXPECT_LT(worst_first, 1e-14);
  EXPECT_LT(worst_second, 1e-13);
}

}  // namespace
}  // namespace hammer_loads
