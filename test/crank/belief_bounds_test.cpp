// How far one blow, one sample and one rival may take the crank's belief: each within a factor of 1.25 of what is said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/contact_rival.h"
#include "support/filter_settings.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kAround = 1.25;

void expectNear(double value, double said) {
  EXPECT_GT(value, said / kAround);
  EXPECT_LT(value, said * kAround);
}

/// A crank at 25 rad/s, 0.3 rad after the blow.
CrankBelief turning() {
  CrankBelief belief;
  belief.state = {{0, {0.3, Side::kAfterBlow}}, 25.0, 100.0, 0.6};
  belief.least_inertia = 1e-6, belief.most_inertia = 1e6;
  belief.covariance.diagonal() << 1e-6, 0.04, 100.0, 1e-4, 1e-4;
  return belief;
}

/// It is neither thrown back nor driven without bound.
TEST(BeliefBounds, OfABlowsFactor) {
  CrankBelief belief = turning();
  belief.factor = -3.0;
  belief.boundFactor();
  expectNear(belief.factor, 0.01);
  belief.factor = 100.0;
  belief.boundFactor();
  expectNear(belief.factor, 4.0);
}

/// What the bound takes off the factor it gives to the speed that goes with it.
TEST(BeliefBounds, ABoundFactorTakesTheSpeedAlong) {
  CrankBelief belief = turning();
  constexpr double kBefore = 13.0;
  belief.factor = -0.3, belief.state.speed = kBefore * belief.factor;
  belief.addNoise(CrankBelief::kSpeed, CrankBelief::kFactor, kBefore * 1e-4);
  belief.boundFactor();
  EXPECT_NEAR(belief.state.speed, kBefore * belief.factor, 1e-9);
}

/// A speed that is off by less than restitutions make of it is the blow's doing; by more it is no blow.
TEST(BeliefBounds, OfABlowThatIsUnlikeTheOthers) {
  for (const double part : {1.0 / kAround, kAround}) {
    CrankBelief belief = turning();
    EXPECT_EQ(belief.doubtBlow(CrankBelief::kSpeed, -part * belief.state.speed, 0.05, 1e-3), part < 1.0);
  }
}

TEST(BeliefBounds, OfADeadCentreWhereNothingStrikes) {
  CrankBelief belief = turning();
  const BlowPrior drawn{0.8, 0.25};
  EXPECT_EQ(belief.priorOf(drawn).deviation, drawn.deviation);
  belief.tool_met = true;
  EXPECT_EQ(belief.priorOf(drawn).mean, 1.0);
  expectNear(belief.priorOf(drawn).deviation, 0.02);
}

TEST(BeliefBounds, OfWhatOneSampleTeachesOfTheInertia) {
  CrankBelief belief = turning();
  belief.covariance(CrankBelief::kInertia, CrankBelief::kInertia) = 10.0;
  belief.covariance(CrankBelief::kAngle, CrankBelief::kInertia) =
      belief.covariance(CrankBelief::kInertia, CrankBelief::kAngle) = 3e-3;
  CrankBelief little = belief;
  little.correct(CrankBelief::kAngle, 1e-4, 1e-6, ConstantErrors::Row::Zero());
  EXPECT_NEAR(std::log(little.state.drive_inertia / 0.6), 0.15, 1e-9);  // 1e-4 of 3e-3 / 2e-6
  belief.correct(CrankBelief::kAngle, 0.01, 1e-6, ConstantErrors::Row::Zero());
  expectNear(std::log(belief.state.drive_inertia / 0.6), 0.3);
}

/// A rocker that may have found no tool: logarithms of odds.
class Rival : public testing::Test {
 protected:
  void SetUp() override { rival_.begin(turning()); }
  /// A sample that speaks for the rival by that much against the estimate.
  void hear(double much) {
    WeighedSample sample{0.3, std::nullopt, 1e-6};
    const double fit = sample.ofAngle(rival_.belief()).logLikelihood() - much;
    rival_.follow(sample, ShaftModel(mechanism_, Level::kRocker), fit, 1.0, 300.0);
  }
  /// offset: of the crank behind the blow [rad].
  bool isChosen(double offset = 0.6) {
    CrankBelief estimate = turning();
    estimate.state.position.angle.offset = offset;
    return rival_.choose(estimate, mirrored_);
  }

  Mechanism mechanism_{test::mechanismOf(test::mo100Parameters())};
  ContactRival rival_;
  bool mirrored_{};
};

/// Without contact is one turn in 600: -6.4. One sample alone may be an outlier.
TEST_F(Rival, OneSampleOfAnyKindLeavesNoDoubt) {
  hear(1e3);
  EXPECT_FALSE(rival_.isDoubtful());  // -6.4 + 8
  hear(0.7);
  EXPECT_TRUE(rival_.isDoubtful());
}

TEST_F(Rival, IsBelievedAtEightThousandToOne) {
  hear(8.0), hear(6.6);
  EXPECT_FALSE(isChosen());  // 8.2
  hear(1.6);
  EXPECT_TRUE(isChosen());
  EXPECT_TRUE(mirrored_);
  EXPECT_TRUE(rival_.isThere()) << "the other one may yet be right";
}

TEST_F(Rival, IsSetAsideAtAHundredThousandToOne) {
  hear(-4.5);
  EXPECT_FALSE(isChosen());
  EXPECT_TRUE(rival_.isOpen());  // -10.9
  hear(-2.5);
  EXPECT_FALSE(isChosen());
  EXPECT_FALSE(rival_.isOpen());
}

/// A rod that rings may speak against the right one: for some 10 ms, 15 of 20 samples.
TEST_F(Rival, IsLookedAtAgainBehindTheDeadCentre) {
  for (int i = 0; i < 15; ++i) {
    hear(-8.0);
    EXPECT_FALSE(isChosen(0.1));
  }
  ASSERT_TRUE(rival_.isThere());
  EXPECT_FALSE(rival_.isOpen());
  EXPECT_EQ(rival_.probability(), 0.0);
  for (int i = 0; i < 5; ++i) {
    hear(8.0);
    EXPECT_FALSE(isChosen(0.45)) << "it may be right by chance there";
  }
  EXPECT_TRUE(isChosen(0.6));
  EXPECT_TRUE(mirrored_);
  EXPECT_TRUE(rival_.isOpen()) << "the other one may yet be right";
  mirrored_ = false;
  rival_.begin(turning());
  for (int i = 0; i < 15; ++i) hear(-8.0), isChosen(0.45);
  EXPECT_TRUE(rival_.isThere());
  isChosen(0.6);
  EXPECT_FALSE(rival_.isThere());
}

/// A machine that has struck in thousand turns is less likely to miss the next one.
TEST_F(Rival, LearnsHowOftenThereIsNoTool) {
  for (int i = 0; i < 600; ++i) {
    rival_.begin(turning());
    hear(-8.0);
    isChosen();
  }
  rival_.begin(turning());
  hear(8.0);
  hear(1.2);
  EXPECT_FALSE(rival_.isDoubtful());  // -6.4 - log(3) + 9.2
  hear(0.6);
  EXPECT_TRUE(rival_.isDoubtful());
}

}  // namespace
}  // namespace hammer_loads
