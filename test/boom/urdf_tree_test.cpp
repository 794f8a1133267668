/// Bodies of a robot description compared with those of kdl_parser of ROS.
#include "hammer_loads/boom/urdf_tree.h"

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <kdl_parser/kdl_parser.hpp>

#include "boom/booms.h"

namespace hammer_loads {
namespace {

/// Robot with joints of every type at inclined and shifted origins, and with inertias in their own axes.
constexpr char kEveryKind[] = R"(<robot name="r"><link name="root"/>
<link name="a"><inertial><origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/><mass value="3"/>
  <inertia ixx="2" iyy="3" izz="4" ixy="0.1" ixz="-0.2" iyz="0.3"/></inertial></link>
<link name="b"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="c"/>
<link name="d"><inertial><origin xyz="1 2 3"/><mass value="7"/>
  <inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0.1" iyz="0"/></inertial></link>
<link name="e"/>
<joint name="ja" type="revolute"><parent link="root"/><child link="a"/><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>
  <axis xyz="0 0.6 0.8"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="jb" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="-1 0 2" rpy="1 0 -1"/>
  <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="jc" type="fixed"><parent link="a"/><child link="c"/><origin rpy="0 0.7 0"/></joint>
<joint name="jd" type="continuous"><parent link="c"/><child link="d"/><axis xyz="0 0 -1"/></joint>
<joint name="je" type="floating"><parent link="b"/><child link="e"/></joint></robot>)";

void expectNear(const KDL::Frame& a, const KDL::Frame& b, const std::string& name) {
  EXPECT_TRUE(KDL::Equal(a, b, 1e-15)) << name;
}

void expectSameBodies(const urdf::ModelInterface& model) {
  KDL::Tree right;
  ASSERT_TRUE(kdl_parser::treeFromUrdfModel(model, right));
  const KDL::Tree tree = treeOf(model);
  ASSERT_EQ(tree.getNrOfSegments(), right.getNrOfSegments());
  ASSERT_EQ(tree.getNrOfJoints(), right.getNrOfJoints());
  for (const auto& [name, element] : right.getSegments()) {
    const auto found = tree.getSegment(name);
    ASSERT_NE(found, tree.getSegments().end()) << name;
    if (name == right.getRootSegment()->first) continue;
    const KDL::Segment& own = GetTreeElementSegment(found->second);
    const KDL::Segment& other = GetTreeElementSegment(element);
    EXPECT_EQ(GetTreeElementParent(found->second)->first, GetTreeElementParent(element)->first);
    EXPECT_EQ(own.getJoint().getType(), other.getJoint().getType()) << name;
    for (const double q : {0.0, 0.7, -1.3}) expectNear(own.pose(q), other.pose(q), name);
    EXPECT_EQ(own.getInertia().getMass(), other.getInertia().getMass());
    EXPECT_TRUE(KDL::Equal(own.getInertia().getCOG(), other.getInertia().getCOG(), 1e-15));
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(own.getInertia().getRotationalInertia().data[i], other.getInertia().getRotationalInertia().data[i],
                  1e-13)
          << name;
    }
  }
}

TEST(UrdfTree, IsThatOfKdlParser) {
  expectSameBodies(*urdf::parseURDF(kEveryKind));
  expectSameBodies(*urdf::parseURDF(test::shippedUrdf()));
}

}  // namespace
}  // namespace hammer_loads
