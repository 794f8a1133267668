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

TEST(JointTorqueOfTipLoad, HasTheDocumentedSign) {
  // Boom and arm are stretched. A force along +z at the hull lifts the boom, against its joint's positive direction.
  Boom boom = test::shippedBoom();
  const JointVector zero = JointVector::Zero(4);
  boom.move({zero, zero, zero}, kLevel);
  const Wrench up{Eigen::Vector3d(0.0, 0.0, 1000.0), Eigen::Vector3d::Zero()};
  const JointVector torque = boom.hammerTorque(up);
  EXPECT_NEAR(torque[1], -1000.0 * (2.60 + 1.70 + 0.10), 1e-9);
  EXPECT_NEAR(torque[3], -1000.0 * 0.10, 1e-9);
  EXPECT_EQ(torque[0], 0.0);
  // The weight's torque has the opposite sign.
  BoomLoads loads;
  boom.loads(up, true, loads);
  EXPECT_GT(loads.weight[1], 0.0);
  // The boom's cylinder raises it by pushing, so the weight requires a push.
  EXPECT_GT(loads.cylinder[0].force, 0.0);
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

TEST(JointLoads, AreEqualAtEveryLink) {
  // A wrench shifted to a link has equal torques on the joints before that link.
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

}  // namespace
}  // namespace hammer_loads
