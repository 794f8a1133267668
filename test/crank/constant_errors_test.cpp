// Errors of the sensor's place: what the filter says they do to it, against a second filter that has them.
#include <gtest/gtest.h>

#include <random>

#include "hammer_loads/crank/crank_filter.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

namespace hammer_loads {
namespace {

/// Angle of a sensor whose place is off by b, from the true one.
double read(double angle, const ConstantErrors::Vector& b) {
  return angle + b[0] + b[1] * std::sin(angle) + b[2] * (std::cos(angle) - 1.0);
}

ConstantErrors::Vector found(const ConstantErrors::Vector& b) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  test::StrikingCrank crank(mechanism.linkage(), 0.737, 0.6);
  CrankFilter filter(ShaftModel(mechanism, Level::kRocker), 0.6, test::filterSettings(kTwoPi / 65536.0, 1e-3));
  std::mt19937 random(3);
  std::normal_distribution<> noise(0.0, 1e-3);
  for (int i = 1; i < 12000; ++i) {
    crank.advanceTo(1e-3 * i);
    const CrankSample sample{read(crank.angle(), b) + noise(random), std::nullopt};
    i == 1 ? filter.start(sample) : static_cast<void>(filter.update(1e-3, sample));
  }
  return filter.constantErrors().estimate();
}

TEST(ConstantErrors, AreSeenInTheInnovations) {
  const ConstantErrors::Vector none = found(ConstantErrors::Vector::Zero());
  for (int i = 0; i < ConstantErrors::kPlace; ++i) EXPECT_NEAR(none[i], 0.0, 3e-3) << i;
  for (int i = 0; i < ConstantErrors::kPlace; ++i) {
    ConstantErrors::Vector b = ConstantErrors::Vector::Zero();
    b[i] = 0.01;
    const ConstantErrors::Vector estimate = found(b) - none;
    for (int k = 0; k < ConstantErrors::kPlace; ++k) EXPECT_NEAR(estimate[k], b[k], 2.5e-3) << i << ' ' << k;
  }
}

}  // namespace
}  // namespace hammer_loads
