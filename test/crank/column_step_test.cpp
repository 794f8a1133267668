// What a constant of the hammer does to a step of the crank, against the step of the other hammer.
#include <gtest/gtest.h>

#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/crank/crank_dynamics.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

/// A mechanism whose every mass, centre and length is a little uncertain.
Mechanism uncertain() {
  HammerParameters p = test::mo100LinkageParameters();
  p.deviations = usualDeviations(p);
  return test::mechanismOf(p);
}

CrankBelief stepped(const ShaftModel& model, double offset, double speed, double torque, double dt) {
  CrankBelief belief;
  belief.state.position.angle = CrankAngle::fromOffset(offset);
  belief.state.speed = speed, belief.state.torque = torque;
  belief.state.drive_inertia = 0.6;
  belief.least_inertia = 0.06, belief.most_inertia = 60.0;
  belief.predict(model, model(belief.state.position.angle), {}, {}, true, 1e3, dt);
  return belief;
}

TEST(ColumnStep, IsTheOtherHammersStep) {
  const Mechanism mechanism = uncertain();
  const ShaftModel model(mechanism, Level::kLinkage);
  const MachineColumns machine(mechanism, Level::kLinkage);
  ASSERT_GT(machine.columns().size(), 10U);
  for (const double dt : {2e-4, 1e-3}) {
    for (const double offset : {-2.0, -1.0, -0.5, -0.2, -0.05, -0.005, 0.03, 0.5, 1.5}) {  // -0.005: over the blow
      for (const double torque : {-50.0, 50.0}) {
        const CrankBelief here = stepped(model, offset, 20.0, torque, dt);
        double size = 0.0;  // of the largest column
        std::vector<std::pair<double, double>> found;
        for (std::size_t i = 0; i < machine.columns().size(); ++i) {
          const MachineColumn& column = machine.columns()[i];
          const ShaftModel other(column.mechanism, Level::kLinkage);
          const CrankBelief there = stepped(other, offset, 20.0, torque, dt);
          const double truth = (there.state.speed - here.state.speed) / column.step;
          size = std::max(size, std::abs(truth));
          found.emplace_back(here.by_constant(CrankBelief::kSpeed, ConstantErrors::kTable + static_cast<int>(i)),
                             truth);
        }
        for (std::size_t i = 0; i < found.size(); ++i)
          EXPECT_NEAR(found[i].first, found[i].second, 0.05 * std::abs(found[i].second) + 0.02 * size)
              << machine.columns()[i].name << " at " << offset << " rad, " << torque << " N m, " << dt << " s";
      }
    }
  }
}

}  // namespace
}  // namespace hammer_loads
