// The description written by scripts/grapple_urdf with the joint positions of a GrappleFlow.
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <kdl_parser/kdl_parser.hpp>

#include "ros/grapple_messages.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

const std::string kSource = std::string(HAMMER_LOADS_TEST_DATA) + "/../../";

std::string described(const std::string& parameter_file) {
  const test::Outcome outcome = test::runCommand(kSource + "scripts/grapple_urdf", parameter_file);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome.out;
}

class Description {
 public:
  explicit Description(const std::string& text) {
    const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    if (!model || !kdl_parser::treeFromUrdfModel(*model, tree_)) throw std::runtime_error("cannot read the URDF");
  }
  /// Returns the pose of a link in the frame `grapple`.
  KDL::Frame frame(const std::string& link, const sensor_msgs::JointState& joints) const {
    KDL::Chain chain;
    EXPECT_TRUE(tree_.getChain("grapple", link, chain)) << link;
    KDL::Frame X = KDL::Frame::Identity();
    for (const KDL::Segment& segment : chain.segments) X = X * segment.pose(position(segment.getJoint(), joints));
    return X;
  }
  const KDL::Tree& tree() const { return tree_; }

 private:
  static double position(const KDL::Joint& joint, const sensor_msgs::JointState& joints) {
    if (joint.getType() == KDL::Joint::None) return 0.0;
    const auto found = std::find(joints.name.begin(), joints.name.end(), joint.getName());
    EXPECT_NE(found, joints.name.end()) << joint.getName();
    return joints.position.at(static_cast<std::size_t>(found - joints.name.begin()));
  }
  KDL::Tree tree_;
};

KDL::Vector polar(double length, double angle) { return {length * std::cos(angle), length * std::sin(angle), 0.0}; }

void expectPinsMeet(const std::string& parameter_file) {
  test::KeptMessages kept;
  GrappleFlow flow(test::grappleSettings(SliderAcceleration::kNone, parameter_file));
  kept.attachTo(flow.outputs());
  const GrappleParameters& k = flow.tracker().grapple().parameters();
  const Description description(described(parameter_file));
  constexpr int kPositions = 200;
  for (int i = 0; i <= kPositions; ++i) {
    const double slider = k.slider_closed + (k.slider_open - k.slider_closed) * i / kPositions;
    flow.jointStates(test::sliderMessage(ros::Time(1.0 + 0.01 * i), slider, 0.1), ros::Time(1.0));
    ASSERT_EQ(kept.mechanisms.size(), static_cast<std::size_t>(i + 1));
    const sensor_msgs::JointState& joints = kept.mechanisms.back().second;
    for (const std::size_t jaw : {0U, 1U}) {
      const std::string side = jaw == 0 ? "left" : "right";
      SCOPED_TRACE(side + " at " + std::to_string(slider));
      const auto X = [&](const char* link) { return description.frame("grapple_" + side + "_" + link, joints); };
      const KDL::Frame rocker = X("rocker"), lever = X("lever"), main_rocker = X("main_rocker");
      const auto meet = [](const KDL::Vector& a, const KDL::Vector& b) { return (a - b).Norm() < 1e-12; };
      EXPECT_TRUE(meet(X("drive_rod") * polar(k.gh, 0.0), rocker * polar(k.o1h, k.ho1a))) << "H";
      EXPECT_TRUE(meet(rocker * polar(k.o1a, 0.0), lever.p)) << "A";
      EXPECT_TRUE(meet(lever * polar(k.ab, 0.0), X("jaw").p)) << "B";
      EXPECT_TRUE(meet(lever * polar(k.ac, k.bac), X("tie_rod").p)) << "C";
      EXPECT_TRUE(meet(X("jaw") * polar(k.bd, 0.0), main_rocker * polar(k.od, 0.0))) << "D";
      EXPECT_TRUE(meet(X("tie_rod") * polar(k.ce, 0.0), main_rocker * polar(k.oe, k.doe))) << "E";
      const geometry_msgs::Point& p = kept.edges[jaw].back().second.point;
      EXPECT_TRUE(meet(X("jaw") * polar(k.bp, k.dbp), {p.x, p.y, p.z})) << "P";
    }
  }
}

TEST(GrappleDescription, PinsMeetOverTheStrokeInBothJaws) {
  expectPinsMeet(test::claimsFile());
  expectPinsMeet(configDirectory() + "/grapple_straight.yaml");
}

TEST(GrappleDescription, PinsMeetWithEveryPivotOffTheAxis) {
  // Unlike in the shipped linkages, no angle and no offset is zero.
  std::vector<std::string> problems;
  ParameterMap given = *readParameterFile(test::claimsFile(), problems);
  std::string yaml;
  for (const auto& [key, value] : {std::pair<const char*, const char*>{"o1_x_m", "0.01"},
                                   {"slider_line_x_m", "0.02"},
                                   {"bac_angle_rad", "0.01"},
                                   {"slider_closed_m", "0.1"},
                                   {"slider_open_m", "0.6"}})
    given[key].value = YAML::Node(value);
  for (const auto& [key, parameter] : given) yaml += key + ": " + parameter.value.Scalar() + "\n";
  const test::TemporaryFile file(yaml);
  expectPinsMeet(file.path());
}

TEST(GrappleDescription, TheShippedOneIsWhatTheScriptWrites) {
  EXPECT_EQ(test::contentOf(kSource + "urdf/grapple_claims.urdf"), described(test::claimsFile()));
}

TEST(GrappleDescription, StandsUprightAndHasNoOtherMovableJoint) {
  const Description description(test::contentOf(kSource + "urdf/grapple_claims.urdf"));
  EXPECT_EQ(description.tree().getNrOfJoints(), 13U) << "as in the message of the mechanism";
  KDL::Chain chain;
  ASSERT_TRUE(description.tree().getChain("grapple_mount", "grapple", chain));
  const KDL::Vector up = chain.getSegment(0).pose(0.0).M * KDL::Vector(0.0, 1.0, 0.0);
  EXPECT_TRUE(KDL::Equal(up, KDL::Vector(0.0, 0.0, 1.0), 1e-15));
}

TEST(GrappleDescription, ReportsABadFileInOneLine) {
  const test::Outcome outcome = test::runCommand(kSource + "scripts/grapple_urdf", configDirectory() + "/log.yaml");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(test::linesOf(outcome.err).size(), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("o1_x_m"), std::string::npos);
}

}  // namespace
}  // namespace hammer_loads
