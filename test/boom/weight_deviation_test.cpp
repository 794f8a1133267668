// Standard deviations of the weight's torques, compared with booms with random masses, centres and joint zeros.
#include <gtest/gtest.h>

#include "boom/booms.h"

namespace hammer_loads {
namespace {

Boom boomOf(const BoomParameters& parameters) { return Boom::make(test::shippedUrdf(), parameters).value.value(); }

/// Returns the standard deviation of the weight's torques, which deviations() finds for the pose.
JointVector weightDeviation(const BoomParameters& parameters, const JointVector& q) {
  Boom boom = boomOf(parameters);
  boom.move({q, test::kZero, test::kZero}, test::kLevel);
  BoomDeviations found;
  boom.deviations(LoadErrors(boom.cylinders()), found);
  return boom.weightDeviation();
}

JointVector torqueOf(Boom& boom, const JointVector& q) {
  boom.move({q, test::kZero, test::kZero}, test::kLevel);
  JointVector torque(4);
  for (int j = 0; j < 4; ++j) torque[j] = boom.steadyTorque(j);
  return torque;
}

class WeightDeviation : public testing::Test {
 protected:
  /// Returns the root mean square of the torques' changes by random draws.
  template <typename Draw>
  JointVector spread(const JointVector& q, const Draw& draw) {
    Boom given = boomOf(parameters_);
    const JointVector right = torqueOf(given, q);
    JointVector square = JointVector::Zero(4);
    constexpr int kDraws = 2000;
    for (int i = 0; i < kDraws; ++i) square += (draw(given) - right).cwiseAbs2();
    return (square / kDraws).cwiseSqrt();
  }
  static void expectAlike(const JointVector& stated, const JointVector& drawn) {
    for (int j = 1; j < 4; ++j) EXPECT_NEAR(stated[j] / drawn[j], 1.0, 0.08) << j;  // 5 standard errors of 1.6 %
    EXPECT_NEAR(stated[0], 0.0, 1e-9) << "about the vertical there is no weight";
  }

  BoomParameters parameters_ = test::shippedBoomParameters();
  std::mt19937 random_{1};
  std::normal_distribution<> normal_;
};

TEST_F(WeightDeviation, IncludesMassesAndCentres) {
  parameters_.link_mass_std = 0.05, parameters_.link_com_std = 0.03;
  const JointVector q = test::workingPosition();
  const auto draw = [&](const Boom& given) {
    BoomParameters drawn = parameters_;
    drawn.sections.clear();
    for (int i = 1; i < given.chain().links(); ++i) {
      WeighedLink link = given.chain().body(i);
      link.mass *= 1.0 + 0.05 * normal_(random_);
      // The error of the centre is independent of that of the mass.
      link.com_x += 0.03 * normal_(random_), link.com_z += 0.03 * normal_(random_);
      drawn.chain.weighed.push_back(link);
    }
    Boom boom = boomOf(drawn);
    return torqueOf(boom, q);
  };
  expectAlike(weightDeviation(parameters_, q), spread(q, draw));
}

TEST_F(WeightDeviation, UsesTheDeviationsOfWeighedLinks) {
  Boom given = boomOf(parameters_);
  for (const char* name : {"boom_link", "arm_link", "hammer_hull"}) {
    WeighedLink link = given.chain().body(*given.chain().linkIndex(name));
    link.moment_x_std = 4.0, link.moment_z_std = 9.0;
    parameters_.chain.weighed.push_back(link);
  }
  parameters_.link_mass_std = parameters_.link_com_std = 0.0;
  const JointVector q = test::workingPosition();
  const auto draw = [&](const Boom&) {
    BoomParameters drawn = parameters_;
    for (WeighedLink& link : drawn.chain.weighed) {
      link.com_x += 4.0 * normal_(random_) / link.mass;
      link.com_z += 9.0 * normal_(random_) / link.mass;
    }
    Boom boom = boomOf(drawn);
    return torqueOf(boom, q);
  };
  expectAlike(weightDeviation(parameters_, q), spread(q, draw));
}

TEST_F(WeightDeviation, IncludesTheJointsZeros) {
  parameters_.link_mass_std = parameters_.link_com_std = 0.0;
  for (CylinderParameters& c : parameters_.cylinders) c.joint_zero_std = 0.004;
  const JointVector q = test::workingPosition();
  const auto draw = [&](Boom& boom) {
    JointVector drawn = q;
    for (int j = 1; j < 4; ++j) drawn[j] += 0.004 * normal_(random_);
    return torqueOf(boom, drawn);
  };
  expectAlike(weightDeviation(parameters_, q), spread(q, draw));
}

}  // namespace
}  // namespace hammer_loads
