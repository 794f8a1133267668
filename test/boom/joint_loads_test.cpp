#include <gtest/gtest.h>

#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "boom/booms.h"
#include "hammer_loads/boom/boom.h"

namespace hammer_loads {
namespace {

using test::kGravity;
using test::kLevel;

double worstOf(const JointVector& a, const JointVector& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// d/dq_j of the tip's place and turn by differences of order 6, each wrench component times its displacement.
double virtualWork(const Chain& chain, const JointVector& q, int j, const Wrench& w_T) {
  constexpr double kStep = 2e-3;
  constexpr double kWeight[] = {45.0, -9.0, 1.0};
  ChainPose pose;
  forwardKinematics(chain, q, pose);
  const Pose here = pose.tip();
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  for (int k = 1; k <= 3; ++k) {
    for (int side : {1, -1}) {
      JointVector moved = q;
      moved[j] += side * k * kStep;
      forwardKinematics(chain, moved, pose);
      rate += side * kWeight[k - 1] / (60.0 * kStep) * pose.tip().matrix();
    }
  }
  const Eigen::Matrix3d spin = rate.topLeftCorner<3, 3>() * here.linear().transpose();
  const Eigen::Vector3d omega(0.5 * (spin(2, 1) - spin(1, 2)), 0.5 * (spin(0, 2) - spin(2, 0)),
                              0.5 * (spin(1, 0) - spin(0, 1)));
  const Eigen::Vector3d v = rate.topRightCorner<3, 1>();
  return (here.linear() * w_T.force).dot(v) + (here.linear() * w_T.torque).dot(omega);
}

TEST(JointTorqueOfTipLoad, IsItsVirtualWork) {
  const Checked<Chain> made = Chain::make(test::shippedUrdf(), {});
  ASSERT_TRUE(made.value);
  std::mt19937 random(11);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = test::randomPosition(*made.value, random);
    const Wrench w = test::randomWrench(random);
    ChainPose pose;
    forwardKinematics(*made.value, q, pose);
    const JointVector torque = jointTorqueOfTipLoad(pose, w);
    Eigen::Matrix<double, 6, 1> stacked;
    stacked << w.force, w.torque;
    EXPECT_LT(worstOf(torque, tipJacobian(pose).transpose() * stacked), 1e-14 * torque.cwiseAbs().maxCoeff());
    for (int j = 0; j < q.size(); ++j) {
      const double error = std::abs(torque[j] - virtualWork(*made.value, q, j, w)) / torque.cwiseAbs().maxCoeff();
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst", format("%.2g", worst));
  EXPECT_LT(worst, 1e-9);
}

TEST(JointTorqueOfTipLoad, HasTheDocumentedSign) {
  // Boom and arm stretched, hull at the end: a force up along +z lifts the boom, against its joint's positive sense.
  Boom boom = test::shippedBoom();
  const JointVector zero = JointVector::Zero(4);
  boom.move({zero, zero, zero}, kLevel);
  const Wrench up{Eigen::Vector3d(0.0, 0.0, 1000.0), Eigen::Vector3d::Zero()};
  const JointVector torque = boom.hammerTorque(up);
  EXPECT_NEAR(torque[1], -1000.0 * (2.60 + 1.70 + 0.10), 1e-9);
  EXPECT_NEAR(torque[3], -1000.0 * 0.10, 1e-9);
  EXPECT_EQ(torque[0], 0.0);
  // Weight drives it the other way.
  BoomLoads loads;
  boom.loads(up, true, loads);
  EXPECT_GT(loads.weight[1], 0.0);
  // The boom's cylinder raises it by pushing: weight makes it push.
  EXPECT_GT(loads.cylinder[0].force, 0.0);
}

TEST(JointTorqueOfWeight, EqualsKdlAndTheSlopeOfPotentialEnergy) {
  const Checked<Chain> made = Chain::make(test::shippedUrdf(), {});
  ASSERT_TRUE(made.value);
  const Chain& chain = *made.value;
  std::mt19937 random(12);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d g = test::randomVector(random, 10.0);
    KDL::ChainDynParam kdl(chain.kdl(), KDL::Vector(g.x(), g.y(), g.z()));
    KDL::JntArray q(chain.kdl().getNrOfJoints()), expected(q.rows());
    q.data = test::randomPosition(chain, random);
    kdl.JntToGravity(q, expected);
    ChainPose pose;
    forwardKinematics(chain, q.data, pose);
    const JointVector torque = jointTorqueOfWeight(chain, pose, g);
    EXPECT_LT(worstOf(torque, -expected.data), 1e-13 * expected.data.cwiseAbs().maxCoeff());

    const auto energy = [&](double shift) {
      JointVector moved = q.data;
      moved[1] += shift;
      forwardKinematics(chain, moved, pose);
      const PointMass all = massFrom(chain, pose, 1);
      return -all.mass * g.dot(all.p);
    };
    const double h = 1e-3;
    const double slope = (8.0 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12.0 * h);
    EXPECT_NEAR(torque[1], -slope, 1e-9 * torque.cwiseAbs().maxCoeff());
  }
}

TEST(JointLoads, TotalEqualsTheHandMadePlanarChain) {
  std::mt19937 random(13);
  double worst = 0.0;
  for (int k = 0; k < 20; ++k) {
    const auto planar = test::PlanarChain<3>::random(random);
    BoomParameters parameters = test::shippedBoomParameters();
    parameters.chain = {"base_link", "tip", {"j0", "j1", "j2"}};
    parameters.cylinders.clear();
    parameters.sections.clear();
    Checked<Boom> boom = Boom::make(planar.urdf(), parameters);
    ASSERT_TRUE(boom.value) << boom.problems.front();
    for (int i = 0; i < 50; ++i) {
      test::PlanarChain<3>::Joints q, qd, qdd;
      for (std::size_t j = 0; j < 3; ++j) {
        q[j] = test::between(random, -3.0, 3.0);
        qd[j] = test::between(random, -2.0, 2.0);
        qdd[j] = test::between(random, -5.0, 5.0);
      }
      const double fx = test::between(random, -5e4, 5e4), fz = test::between(random, -4e4, 4e4);
      const double ty = test::between(random, -5e3, 5e3);
      const auto expected = planar.loads(q, qd, qdd, {fx, fz}, ty);
      const auto vector = [](const auto& values) { return test::joints({values[0], values[1], values[2]}); };
      boom.value->move({vector(q), vector(qd), vector(qdd)}, kLevel);
      BoomLoads loads;
      boom.value->loads({Eigen::Vector3d(fx, 0.0, fz), Eigen::Vector3d(0.0, ty, 0.0)}, true, loads);
      const double size = vector(expected).cwiseAbs().maxCoeff();
      worst = std::max(worst, worstOf(loads.total, vector(expected)) / size);
    }
  }
  RecordProperty("worst", format("%.2g", worst));
  EXPECT_LT(worst, 1e-10);
}

TEST(JointLoads, TotalEqualsOneCallOfKdlWithEverything) {
  Boom boom = test::shippedBoom();
  const Chain& chain = boom.chain();
  KDL::ChainIdSolver_RNE kdl(chain.kdl(), KDL::Vector(0.0, 0.0, -kGravity));
  std::mt19937 random(14);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = test::randomPosition(chain, random);
    JointVector qd(4), qdd(4);
    for (int j = 0; j < 4; ++j) qd[j] = test::between(random, -1, 1), qdd[j] = test::between(random, -5, 5);
    const Wrench w = test::randomWrench(random);
    KDL::JntArray q_kdl(4), qd_kdl(4), qdd_kdl(4), torque(4);
    q_kdl.data = q, qd_kdl.data = qd, qdd_kdl.data = qdd;
    KDL::Wrenches wrenches(chain.kdl().getNrOfSegments(), KDL::Wrench::Zero());
    wrenches.back() = KDL::Wrench(KDL::Vector(w.force.x(), w.force.y(), w.force.z()),
                                  KDL::Vector(w.torque.x(), w.torque.y(), w.torque.z()));
    kdl.CartToJnt(q_kdl, qd_kdl, qdd_kdl, wrenches, torque);
    boom.move({q, qd, qdd}, kLevel);
    BoomLoads loads;
    boom.loads(w, true, loads);
    worst = std::max(worst, worstOf(loads.total, -torque.data) / torque.data.cwiseAbs().maxCoeff());
    EXPECT_EQ(loads.total, loads.hammer + loads.weight + loads.motion + loads.vibration);
    EXPECT_TRUE(loads.vibration.isZero(0.0));
  }
  RecordProperty("worst", format("%.2g", worst));
  EXPECT_LT(worst, 1e-12);
}

TEST(JointLoads, MassMatrixEqualsTheHandMadePlanarChain) {
  std::mt19937 random(15);
  for (int k = 0; k < 20; ++k) {
    const auto planar = test::PlanarChain<3>::random(random);
    const Checked<Chain> chain = Chain::make(planar.urdf(), {"base_link", "tip", {}});
    ASSERT_TRUE(chain.value);
    ChainDynamics dynamics(*chain.value);
    const test::PlanarChain<3>::Joints q{test::between(random, -3, 3), test::between(random, -3, 3),
                                         test::between(random, -3, 3)};
    const Eigen::Matrix3d expected = planar.massMatrix(q);
    const JointMatrix M = dynamics.massMatrix(test::joints({q[0], q[1], q[2]}));
    EXPECT_LT((M - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.norm());
  }
}

TEST(JointLoads, AreEqualAtEveryLink) {
  // The wrench shifted to a link turns the joints before that link as the wrench at the hull does.
  Boom boom = test::shippedBoom();
  const Chain& chain = boom.chain();
  std::mt19937 random(16);
  for (int i = 0; i < 100; ++i) {
    const JointVector q = test::randomPosition(chain, random);
    boom.move({q, JointVector::Zero(4), JointVector::Zero(4)}, kLevel);
    const Wrench w = test::randomWrench(random);
    const JointVector torque = boom.hammerTorque(w);
    for (int j = 0; j < chain.joints(); ++j) {
      // At the frame of the joint itself its torque is the moment about the axis; swing turns about z, others about y.
      const Wrench there = wrenchAtLink(boom.pose(), chain.linkBeyond(j), w);
      EXPECT_NEAR(there.torque.dot(chain.link(chain.linkBeyond(j)).axis), torque[j], 1e-10 * torque.norm());
    }
    const Wrench here = wrenchAtLink(boom.pose(), chain.tip(), w);
    EXPECT_LT((here.force - w.force).norm(), 1e-15 * w.force.norm());
  }
}

TEST(JointLoads, GravityAtTheTipFollowsPitch) {
  Boom boom = test::shippedBoom();
  const JointVector zero = JointVector::Zero(4);
  boom.move({test::joints({0.7, -0.3, 1.1, -0.6}), zero, zero}, kLevel);
  const Eigen::Vector3d g = boom.gravityAtTip();
  const double pitch = -0.3 + 1.1 - 0.6;
  EXPECT_NEAR(g.x(), kGravity * std::sin(pitch), 1e-14);
  EXPECT_NEAR(g.y(), 0.0, 1e-14);
  EXPECT_NEAR(g.z(), -kGravity * std::cos(pitch), 1e-14);
}

}  // namespace
}  // namespace hammer_loads
