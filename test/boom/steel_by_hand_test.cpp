// Section loads and joint reactions of a bar, calculated by hand, and of a boom with a cylinder at zero moment arm.
#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/boom/steel_loads.h"

namespace hammer_loads {
namespace {

using test::kGravity;

TEST(SteelByHand, EqualsACantileverWithALoadAtItsEnd) {
  // A level bar of 4 m and 80 kg is held at its joint. At its end act 1 kN downwards and 500 N to the side.
  const std::string urdf =
      "<robot name=\"bar\"><link name=\"base_link\"/><link name=\"bar\"><inertial><origin xyz=\"2 0 0\"/>"
      "<mass value=\"80\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"106.6666666\" iyz=\"0\" izz=\"106.6666666\"/>"
      "</inertial></link><link name=\"hammer_hull\"/>"
      "<joint name=\"j\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"bar\"/><axis xyz=\"0 1 0\"/>"
      "</joint><joint name=\"end\" type=\"fixed\"><parent link=\"bar\"/><child link=\"hammer_hull\"/>"
      "<origin xyz=\"4 0 0\"/></joint></robot>";
  BoomParameters parameters = test::shippedBoomParameters();
  parameters.cylinders.clear();
  parameters.sections = {{"quarter", "bar", {1.0, 0.0, 0.0}, 0.0, {}}, {"turned", "bar", {3.0, 0.0, 0.0}, 0.5, {}}};
  Checked<Boom> made = Boom::make(urdf, parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  const JointVector zero = JointVector::Zero(1);
  made.value->move({zero, zero, zero}, {0.0, 0.0, -kGravity});
  SteelLoads loads;
  ASSERT_TRUE(made.value->steelLoads({{0.0, 500.0, -1000.0}, Eigen::Vector3d::Zero()}, true, loads));
  // Beyond 1 m: 60 kg with its centre 1.5 m away.
  const Wrench& w = loads.section[0];
  EXPECT_LT((w.force - Eigen::Vector3d(0.0, 500.0, -1000.0 - 60.0 * kGravity)).norm(), 1e-10);
  // A downward force at x > 0 has a positive moment about +y.
  EXPECT_LT((w.torque - Eigen::Vector3d(0.0, 3.0 * 1000.0 + 1.5 * 60.0 * kGravity, 3.0 * 500.0)).norm(), 1e-9);
  // The cut is rotated by 0.5 rad about y, so that its x axis points downwards. Beyond it are 20 kg.
  const double down = 1000.0 + 20.0 * kGravity;
  EXPECT_NEAR(loads.section[1].force.x(), down * std::sin(0.5), 1e-9);
  EXPECT_NEAR(loads.section[1].force.z(), -down * std::cos(0.5), 1e-9);
  EXPECT_NEAR(loads.section[1].torque.y(), 1000.0 + 0.5 * 20.0 * kGravity, 1e-9);
  EXPECT_NEAR(loads.joint[0].force.z(), -1000.0 - 80.0 * kGravity, 1e-9);
  EXPECT_NEAR(loads.joint[0].torque.y(), 4000.0 + 160.0 * kGravity, 1e-9);
  // The bar accelerates about its joint. The inertia of the part beyond acts backwards: 60 kg at 2.5 m, 45 kg m2.
  JointVector fast = JointVector::Constant(1, 2.0), faster = JointVector::Constant(1, 3.0);
  made.value->move({zero, fast, faster}, Eigen::Vector3d::Zero());
  ASSERT_TRUE(made.value->steelLoads({}, true, loads));
  EXPECT_NEAR(loads.section[0].force.x(), 60.0 * 2.5 * 4.0, 1e-9);
  EXPECT_NEAR(loads.section[0].force.z(), 60.0 * 2.5 * 3.0, 1e-9);
  EXPECT_NEAR(loads.section[0].torque.y(), -(60.0 * 2.5 * 1.5 + 60.0 * 9.0 / 12.0) * 3.0, 1e-9);
}

TEST(SteelAtDeadCentre, LeavesOnlyTheSectionsUnknownThatTheCylinderCrosses) {
  BoomParameters parameters = test::shippedBoomParameters();
  CylinderParameters& p = parameters.cylinders[0];
  p.base_x = 0.25 - 1.0, p.base_z = 0.40, p.rod_x = 1.0, p.rod_z = 0.0, p.closed_length = 1.5, p.stroke = 0.6;
  Checked<Boom> made = Boom::make(test::shippedUrdf(), parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  const JointVector zero = JointVector::Zero(4);
  made.value->move({test::joints({0.0, 0.0, 1.0, -1.0}), zero, zero}, {0.0, 0.0, -kGravity});
  SteelLoads loads;
  EXPECT_TRUE(made.value->steelLoads({}, true, loads));
  EXPECT_TRUE(std::isnan(loads.section[0].torque.y()));  // before the pin at 1.0 m
  EXPECT_TRUE(loads.section[1].torque.allFinite());      // beyond it
  EXPECT_TRUE(loads.section[2].torque.allFinite());
  EXPECT_TRUE(loads.joint[0].torque.allFinite());
  EXPECT_TRUE(std::isnan(loads.joint[1].force.x()));
  EXPECT_TRUE(loads.joint[2].force.allFinite());
  // An infinite load is reported as a failure, unlike an unknown one.
  EXPECT_FALSE(made.value->steelLoads({Eigen::Vector3d(1e300, 1e308, 0.0), {}}, true, loads));
}

}  // namespace
}  // namespace hammer_loads
