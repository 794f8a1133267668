// Rock force found from cylinder pressures, compared with the true force.
#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/boom/hold_down.h"

namespace hammer_loads {
namespace {

using test::kLevel;

TEST(ContactLoad, IsFoundFromThePressuresThatHoldIt) {
  Boom boom = test::shippedBoom();
  std::mt19937 random(71);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const JointVector q = test::randomPosition(boom.chain(), random), zero = JointVector::Zero(4);
    boom.move({q, zero, zero}, kLevel);
    const Wrench hammer{{1e3, 0.0, 8e3}, {0.0, -700.0, 0.0}};
    const Wrench rock{{test::between(random, -3e3, 3e3), 0.0, test::between(random, 0.0, 2e4)},
                      {0.0, test::between(random, -4e3, 4e3), 0.0}};
    BoomLoads with, without;
    boom.loads({hammer.force + rock.force, hammer.torque + rock.torque}, true, with);
    boom.loads(hammer, true, without);
    // Gauge pressures; the chamber without load has 3 bar.
    JointVector unexplained = JointVector::Zero(4);
    for (std::size_t k = 0; k < 3; ++k) {
      const Cylinder& c = boom.cylinders()[k];
      const double force = with.cylinder[k].force;
      const ChamberPressures p = force > 0.0 ? ChamberPressures{(force + 3e5 * c.rodArea()) / c.boreArea(), 3e5}
                                             : ChamberPressures{3e5, (-force + 3e5 * c.boreArea()) / c.rodArea()};
      EXPECT_NEAR(forceOf(c, p), force, 1e-9 * std::abs(force) + 1e-9);
      unexplained[c.joint()] = -forceOf(c, p) * c.at(q[c.joint()]).arm - without.total[c.joint()];
    }
    const InPlaneTip tip(boom.tipJacobian(), {1, 2, 3});
    if (!tip.isKnown()) continue;
    ++found;
    const Wrench contact = tip.load(unexplained);
    EXPECT_LT((contact.force - rock.force).norm(), 1e-7);
    EXPECT_LT((contact.torque - rock.torque).norm(), 1e-7);
  }
  EXPECT_GT(found, 150);
}

TEST(ContactLoad, IsNotKnownWhereBoomAndArmAreInLine) {
  // Three joints about y, with boom and arm in line.
  const std::string urdf = test::PlanarChain<3>{{{{{2.0, 0.0}, {1.0, 0.0}, 100.0, 10.0},
                                                  {{1.5, 0.0}, {0.7, 0.0}, 80.0, 8.0},
                                                  {{0.5, 0.0}, {0.2, 0.0}, 50.0, 5.0}}}}
                               .urdf();
  const Chain chain = *Chain::make(urdf, {"base_link", "tip", {}}).value;
  ChainPose pose;
  forwardKinematics(chain, test::joints({0.3, 0.0, 0.4}), pose);
  EXPECT_FALSE(InPlaneTip(tipJacobian(pose), {0, 1, 2}).isKnown());
  forwardKinematics(chain, test::joints({0.3, 0.5, 0.4}), pose);
  EXPECT_TRUE(InPlaneTip(tipJacobian(pose), {0, 1, 2}).isKnown());
}

}  // namespace
}  // namespace hammer_loads
