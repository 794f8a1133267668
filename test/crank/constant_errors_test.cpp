// Errors of the sensor's place: what the filter says they do to it, against a second filter that has them.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/util/square.h"
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

/// What is off for certain is part of the uncertainty with what is not known of it; what may be nothing is not.
TEST(ConstantErrors, CountsACertainConstantWithItsDeviation) {
  const auto momentOf = [](double b) {
    ConstantErrors errors;
    for (int turn = 0; turn < 12; ++turn) {
      for (double offset = -3.1; offset < 3.1; offset += 0.2)
        errors.learn(b, 1e-6, ConstantErrors::ofAngle({offset, 30.0, 0.0}));
      errors.endTurn(1.0, 0.0);
    }
    EXPECT_NEAR(errors.estimate()[0], b, 0.05 * b);
    return std::sqrt(errors.moment()(0, 0)) / b;
  };
  EXPECT_NEAR(momentOf(0.004), 1.0, 0.05);
  EXPECT_LT(momentOf(0.0005), 0.8);
}

/// On which side of the blow a sample is cannot wait for it.
TEST(ConstantErrors, AZeroIsSeenBeforeAnythingElseIsConcluded) {
  const auto seen = [](double zero, double variance) {
    ConstantErrors errors;
    std::vector<double> after;
    for (int turn = 0; turn < 8; ++turn) {
      for (int i = 0; i < 40; ++i) errors.learn(zero, variance, ConstantErrors::ofAngle({-3.0 + 0.15 * i, 30.0, 0.0}));
      errors.endTurn(1.0, 0.0);
      after.push_back(errors.zeroSeen());
    }
    return after;
  };
  for (const double s : seen(0.03, 1e-6)) EXPECT_NEAR(s, 0.03, 2e-3);
  for (const double s : seen(0.002, 1e-6)) EXPECT_EQ(s, 0.0) << "a clean machine's";
  for (const double s : seen(0.03, 0.1)) EXPECT_EQ(s, 0.0) << "not seen well enough";
}

}  // namespace
}  // namespace hammer_loads
