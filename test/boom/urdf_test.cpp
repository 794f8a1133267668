#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "boom/booms.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

/// Shipped description with the frames that TF would publish.
class Model : public testing::Test {
 protected:
  Model() : model_(urdf::parseURDF(test::shippedUrdf())) {
    if (!model_ || !kdl_parser::treeFromUrdfModel(*model_, tree_)) throw std::runtime_error("cannot read the URDF");
  }

  /// Returns the position of a joint, from the joint that it mimics if there is one. Joints not named are at zero.
  double position(const std::string& joint, const std::map<std::string, double>& angles) const {
    const urdf::JointConstSharedPtr found = model_->getJoint(joint);
    if (found && found->mimic)
      return found->mimic->multiplier * position(found->mimic->joint_name, angles) + found->mimic->offset;
    const auto angle = angles.find(joint);
    return angle == angles.end() ? 0.0 : angle->second;
  }
  KDL::Frame frame(const std::string& link, const std::map<std::string, double>& angles = {}) const {
    KDL::Chain chain;
    EXPECT_TRUE(tree_.getChain("base_link", link, chain)) << link;
    KDL::Frame X = KDL::Frame::Identity();
    for (const KDL::Segment& segment : chain.segments)
      X = X * segment.pose(position(segment.getJoint().getName(), angles));
    return X;
  }
  double mass(const std::string& link) const {
    const urdf::InertialSharedPtr inertial = model_->getLink(link)->inertial;
    return inertial ? inertial->mass : 0.0;
  }

  urdf::ModelInterfaceSharedPtr model_;
  KDL::Tree tree_;
};

Mechanism shippedMechanism() {
  std::vector<std::string> problems, notes;
  ParameterReader reader(*readParameterFile(test::sourceFile("config/hammer_mo100.yaml"), problems));
  return *readMechanism(reader, notes);
}

TEST_F(Model, AllFramesAreAlignedAtZero) {
  for (const auto& [name, link] : model_->links_) {
    if (name == "base_link") continue;
    EXPECT_TRUE(KDL::Equal(frame(name).M, KDL::Rotation::Identity(), 1e-15)) << name;
  }
}

TEST_F(Model, PinsMeetAllAroundTheTurn) {
  const Mechanism mechanism = shippedMechanism();
  const LinkLengths& l = mechanism.parameters().lengths;
  const double a = mechanism.parameters().rocker_com_angle;
  /// Returns the unit vector e^(i angle) of the mechanism frame in hull axes (model.md 1).
  const auto direction = [&](double angle) {
    const double xi = std::cos(angle), eta = std::sin(angle);
    return KDL::Vector(-(std::cos(a) * xi + std::sin(a) * eta), 0.0, -std::sin(a) * xi + std::cos(a) * eta);
  };
  const KDL::Frame X_hull = frame("hammer_hull").Inverse();
  for (int degree = 0; degree <= 720; degree += 3) {
    const double phi = degree * kPi / 180.0;
    const LinkMotion motion = linkMotion(mechanism.linkage(), CrankAngle::fromAngle(phi));
    const double psi = rockerAngle(motion.rocker), beta = rodAngle(motion);
    const std::map<std::string, double> angles{
        {"hammer_crank_joint", phi}, {"hammer_rod_joint", beta}, {"hammer_rocker_joint", psi}};
    // Pins by the description: the link's frame, then the link's length along its direction at zero.
    const KDL::Frame crank = X_hull * frame("hammer_crank", angles), rod = X_hull * frame("hammer_rod", angles);
    const KDL::Frame rocker = X_hull * frame("hammer_rocker", angles);
    const KDL::Vector at_zero = direction(0.0);
    const KDL::Vector C_rod = rod * (l.rod * at_zero), C_rocker = rocker * (l.rocker * at_zero);
    EXPECT_TRUE(KDL::Equal(C_rod, C_rocker, 1e-14)) << degree;
    // Pins by the equations of model.md 1.
    const KDL::Vector A = -l.pivot_distance * direction(0.0);
    EXPECT_TRUE(KDL::Equal(crank.p, A, 1e-14));
    EXPECT_TRUE(KDL::Equal(rod.p, A + l.crank * direction(phi), 1e-14)) << degree;
    EXPECT_TRUE(KDL::Equal(rocker.p, KDL::Vector::Zero(), 1e-14));
    EXPECT_TRUE(KDL::Equal(C_rocker, l.rocker * direction(psi), 1e-14)) << degree;
    // Centre of mass of the rocker: -ls along x at the blow, S = ls (-cos psi, sin psi) in (x, z).
    const KDL::Vector S = rocker * KDL::Vector(-0.106, 0.0, 0.0);
    EXPECT_TRUE(KDL::Equal(S, KDL::Vector(-0.106 * std::cos(psi), 0.0, 0.106 * std::sin(psi)), 1e-14)) << degree;
  }
}

TEST_F(Model, ToolIsOnTheStrikingLine) {
  const KDL::Frame tool = frame("hammer_hull").Inverse() * frame("hammer_tool");
  EXPECT_NEAR(tool.p.x(), -shippedMechanism().parameters().striking_distance, 1e-4);
  EXPECT_LT(tool.p.z(), 0.0);
}

TEST_F(Model, SimulatedMachineStandsTheToolOnTheGround) {
  std::vector<std::string> problems;
  const ParameterMap machine = *readParameterFile(test::sourceFile("config/simulated_machine.yaml"), problems);
  std::map<std::string, double> angles;
  for (const std::string joint : {"swing", "boom", "arm", "hammer"})
    angles[joint + "_joint"] = machine.at(joint + "_mean_rad").value.as<double>();
  const KDL::Frame tool = frame("hammer_tool", angles);
  EXPECT_NEAR(tool.p.z(), 0.0, 0.02);
  EXPECT_NEAR(tool.M.UnitZ().z(), 1.0, 1e-12);
}

TEST_F(Model, HasThePublishedFigures) {
  const double hammer = mass("hammer_link") + mass("hammer_hull") + mass("hammer_tool");
  EXPECT_NEAR(hammer, 400.0, 1.0);
  constexpr double kBucket = 300.0;
  EXPECT_NEAR(mass("body") + mass("swing_link") + mass("boom_link") + mass("arm_link") + kBucket, 6100.0, 1.0);
  // The masses of the moving links are included once, in the hull.
  for (const char* link : {"hammer_crank", "hammer_carrier", "hammer_rod", "hammer_rocker"}) EXPECT_EQ(mass(link), 0.0);
  const urdf::JointLimitsSharedPtr swing = model_->getJoint("swing_joint")->limits;
  EXPECT_NEAR(swing->upper - swing->lower, 160.0 * kPi / 180.0, 1e-3);
  // Lowest position: boom down, arm and hammer straight below.
  const double boom = model_->getJoint("boom_joint")->limits->upper, arm = 0.5 * kPi - boom;
  const KDL::Frame tool =
      frame("hammer_tool", {{"boom_joint", boom}, {"arm_joint", arm}, {"hammer_joint", -0.5 * kPi}});
  EXPECT_LE(tool.p.z(), -3.4);
  EXPECT_GE(tool.p.z(), -4.25);
  EXPECT_LE(arm, model_->getJoint("arm_joint")->limits->upper);
}

}  // namespace
}  // namespace hammer_loads
