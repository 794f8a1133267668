// The supply's law, against a pump of constant flow that feeds a motor through a hose: own equations, in small steps.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_filter.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

namespace hammer_loads {
namespace {

struct Follow {
  double stiffness{};     ///< as learned [N m/rad]
  double torque_error{};  ///< root of mean square over the last turns [N m]
};

/// A minute's third of a crank at 200 Hz whose stamps jitter by 0.3 ms, without speeds. hose: torque per angle that the
/// crank takes more than the pump gives [N m/rad].
Follow followed(double hose) {
  constexpr double kFlow = 29.0, kLeak = 4.0, kStep = 1e-4;  // [rad/s], torque lost [1/s], [s]
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  test::StrikingCrank crank(mechanism.linkage(), 0.737, 0.6);
  CrankFilter filter(ShaftModel(mechanism, Level::kRocker), 0.6, test::filterSettings(kTwoPi / 4096.0, 0.0));
  std::mt19937 random(3);
  std::normal_distribution<> jitter(0.0, 3e-4);
  double now = 0.0, squares = 0.0;
  int judged = 0;
  for (int i = 1; i <= 4000; ++i) {
    const double until = 5e-3 * i + jitter(random);
    for (; now + kStep <= until; now += kStep) {
      crank.torque += kStep * (hose * (kFlow - crank.speed()) + kLeak * (150.0 - crank.torque));
      crank.advanceTo(now + kStep);
    }
    const CrankSample sample{std::floor(crank.angle() * 4096.0 / kTwoPi) * kTwoPi / 4096.0, std::nullopt};
    i == 1 ? filter.start(sample) : static_cast<void>(filter.update(5e-3, sample));
    if (i > 2000) squares += std::pow(filter.state().torque - crank.torque, 2), ++judged;
  }
  return {filter.walks().supply.stiffness, std::sqrt(squares / judged)};
}

TEST(SupplyLaw, IsLearnedFromTheHose) {
  const Follow stiff = followed(60.0), soft = followed(5.0);
  std::printf("[          ] learned %.1f of 60, %.1f of 5 N m/rad; torque within %.1f, %.1f N m\n", stiff.stiffness,
              soft.stiffness, stiff.torque_error, soft.torque_error);
  EXPECT_NEAR(stiff.stiffness, 60.0, 20.0);
  EXPECT_LT(soft.stiffness, 20.0);
}

/// After ten thousand innovations, each `memory` times the one before and noise, of variance 4.
double factorAfter(double memory, double jitter) {
  SupplyRoughness supply;
  std::mt19937 random(3);
  std::normal_distribution<> normal;
  double innovation = 0.0;
  for (int i = 0; i < 10000; ++i) {
    innovation = memory * innovation + 2.0 * std::sqrt(1.0 - memory * memory) * normal(random);
    supply.learn(innovation, 4.0, jitter);
  }
  return supply.factor();
}

TEST(SupplyRoughness, IsRougherWhereInnovationsKeepTheirSign) {
  EXPECT_GT(factorAfter(0.3, 0.8), 2.0);
  EXPECT_LT(factorAfter(-0.3, 0.8), 0.5);
}

TEST(SupplyRoughness, IsTheGivenOneWhileStampsAreExact) {
  EXPECT_EQ(factorAfter(0.3, 0.0), 1.0);
  EXPECT_EQ(factorAfter(-0.3, 0.0), 1.0);
}

}  // namespace
}  // namespace hammer_loads
