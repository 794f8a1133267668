/// The live node with a robot description, between joint states, TF and a crank at 1 kHz. The machine works on through
/// all tests, which follow each other as written.
#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "ros/boom_machine.h"
#include "support/bad_booms.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

using test::eventually;
using test::kJoints;
using test::Machine;

constexpr double kSide = 0.8;    // [m] from arm_link back to the strain gauge: 2.5 m from the hammer's joint
constexpr double kMaxAge = 0.2;  // [s] of joint states, as shipped

class BoomTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    machine_ = new Machine;
    ASSERT_TRUE(eventually([] { return machine_->isConnected(); })) << "the nodes must be there";
  }
  static void TearDownTestSuite() { delete machine_; }

  static ros::Time now() { return machine_->samples.back() + ros::Duration(1e-9); }
  /// Crank samples with stamps in [from, to).
  static std::size_t samples(const ros::Time& from, const ros::Time& to) {
    const auto& all = machine_->samples;
    return static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), to) -
                                    std::lower_bound(all.begin(), all.end(), from));
  }
  /// All of an output but of samples beside a blow.
  template <typename Output>
  static bool isWhole(const Output& output, const ros::Time& from, const ros::Time& to) {
    const std::size_t all = samples(from, to), there = output.count(from, to);
    return there <= all && static_cast<double>(there) >= 0.98 * static_cast<double>(all);
  }
  /// Everything of the boom that needs no TF comes again.
  static bool isWhole() {
    return machine_->workUntil([] { return machine_->loads.last() >= machine_->samples.back(); });
  }

  static Machine* machine_;
};
Machine* BoomTest::machine_ = nullptr;

/// By hand: from arm_link to D, and the same load there.
geometry_msgs::Wrench atArm(const geometry_msgs::Wrench& hull, double hammer_joint) {
  const double c = std::cos(hammer_joint), s = std::sin(hammer_joint);
  const double x = 1.70 + 0.10 * c - 0.55 * s, z = -0.10 * s - 0.55 * c;
  geometry_msgs::Wrench w;
  w.force.x = c * hull.force.x + s * hull.force.z;
  w.force.z = -s * hull.force.x + c * hull.force.z;
  w.torque.y = hull.torque.y + z * w.force.x - x * w.force.z;
  return w;
}

void expectNear(const geometry_msgs::Wrench& told, const geometry_msgs::Wrench& right) {
  constexpr double kRounding = 1e-8;  // [N, N m] of some 1e4 N and 1e5 N m
  EXPECT_NEAR(told.force.x, right.force.x, kRounding);
  EXPECT_NEAR(told.force.y, right.force.y, kRounding);
  EXPECT_NEAR(told.force.z, right.force.z, kRounding);
  EXPECT_NEAR(told.torque.x, right.torque.x, kRounding);
  EXPECT_NEAR(told.torque.y, right.torque.y, kRounding);
  EXPECT_NEAR(told.torque.z, right.torque.z, kRounding);
}

TEST_F(BoomTest, AJointMissingFromTheStartSilencesTheJointLoadsAlone) {
  machine_->speaking = {"boom_joint", "swing_joint", "hammer_joint"};
  ASSERT_TRUE(machine_->workFor(0.1));
  // A report from before the others' first message may name them too.
  EXPECT_TRUE(eventually(
      [] { return machine_->says("boom", "arm_joint: never heard") && !machine_->says("boom", "hammer_joint"); }));
  EXPECT_TRUE(eventually([] { return machine_->hull.messages.size() == machine_->samples.size(); }));
  EXPECT_TRUE(machine_->loads.messages.empty() && machine_->arm.messages.empty());
  machine_->speaking = {"arm_joint", "hammer_joint", "boom_joint", "swing_joint"};
  ASSERT_TRUE(isWhole());
  EXPECT_TRUE(eventually([] { return machine_->says("boom", "compliant"); }));
}

TEST_F(BoomTest, EveryCrankSampleGivesEveryOutput) {
  ASSERT_TRUE(isWhole());
  const ros::Time from = now();
  ASSERT_TRUE(machine_->workFor(3.0));
  const ros::Time to = now();
  const auto whole = [&](const auto& output) { return output.count(from, to) == machine_->hull.count(from, to); };
  EXPECT_TRUE(eventually([&] {
    return isWhole(machine_->hull, from, to) && whole(machine_->arm) && whole(machine_->loads) &&
           whole(machine_->vibration);
  }));
  EXPECT_NEAR(static_cast<double>(samples(from, to)), 3000.0, 21.0);
  double largest = 0.0;
  const auto end = machine_->hull.messages.lower_bound(to);
  for (auto hull = machine_->hull.messages.lower_bound(from); hull != end; ++hull) {
    const auto& [stamp, wrench] = *hull;
    ASSERT_TRUE(std::binary_search(machine_->samples.begin(), machine_->samples.end(), stamp)) << stamp;
    const auto& arm = machine_->arm.messages.at(stamp);
    EXPECT_EQ(arm.header.frame_id, "arm_link");
    expectNear(arm.wrench, atArm(wrench.wrench, machine_->position[3]));
    const JointLoads& loads = machine_->loads.messages.at(stamp);
    ASSERT_EQ(loads.joint.size(), kJoints.size());
    for (std::size_t j = 0; j < kJoints.size(); ++j) {
      const JointLoad& joint = loads.joint[j];
      EXPECT_EQ(joint.name, kJoints[j]);
      const double sum = joint.hammer_torque + joint.weight_torque + joint.motion_torque + joint.vibration_torque;
      EXPECT_NEAR(joint.total_torque, sum, 1e-9);
    }
    for (const CylinderLoad& cylinder : loads.cylinder) EXPECT_TRUE(std::isfinite(cylinder.force)) << stamp;
    EXPECT_EQ(machine_->vibration.messages.at(stamp).natural_frequency.size(), 3U);
    largest = std::max(largest, std::abs(arm.wrench.torque.y));
    if (HasFailure()) return;
  }
  EXPECT_GT(largest, 5e3) << "the machine must have struck";
  EXPECT_EQ(machine_->hull.repeated + machine_->loads.repeated + machine_->arm.repeated, 0);
}

TEST_F(BoomTest, AFrameUnknownToTfIsSilentAndNamedUntilItsTransformComes) {
  ASSERT_TRUE(isWhole());
  const ros::Time from = now();
  ASSERT_TRUE(machine_->workUntil([] { return machine_->says("frames", "strain_gauge: no transform"); }));
  ASSERT_TRUE(isWhole());
  EXPECT_TRUE(machine_->gauge.messages.empty());
  EXPECT_TRUE(eventually([&] { return isWhole(machine_->arm, from, now()); }));
  EXPECT_TRUE(eventually([&] { return isWhole(machine_->hull, from, now()); }));

  ros::NodeHandle node;
  ros::Publisher tf_static = node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  geometry_msgs::TransformStamped mount;  // x of the gauge along -z of the arm, its z along the arm's x
  mount.header.frame_id = "arm_link";
  mount.child_frame_id = "strain_gauge";
  mount.transform.translation.x = -kSide;
  mount.transform.rotation.y = mount.transform.rotation.w = std::sqrt(0.5);
  tf2_msgs::TFMessage message;
  message.transforms = {mount};
  tf_static.publish(message);

  ASSERT_TRUE(machine_->workUntil([] { return !machine_->gauge.messages.empty(); }));
  const ros::Time back = machine_->gauge.last();
  ASSERT_TRUE(machine_->workFor(1.0));
  const ros::Time goal = now();
  // The robot_state_publisher may skip a joint state: then only the next one brings what waits.
  ASSERT_TRUE(machine_->workUntil([&] { return machine_->gauge.last() >= goal; }));
  EXPECT_TRUE(eventually([&] { return machine_->gauge.count(back, goal) == machine_->hull.count(back, goal); }))
      << "none lost";
  double largest = 0.0;
  for (const auto& [stamp, told] : machine_->gauge.messages) {
    if (stamp >= goal) break;
    geometry_msgs::Wrench arm = atArm(machine_->hull.messages.at(stamp).wrench, machine_->position[3]), right;
    right.force.x = -arm.force.z;
    right.force.z = arm.force.x;
    right.torque.y = arm.torque.y - kSide * arm.force.z;
    EXPECT_EQ(told.header.frame_id, "strain_gauge");
    expectNear(told.wrench, right);
    largest = std::max(largest, std::abs(right.torque.y - arm.torque.y));
    if (HasFailure()) return;
  }
  EXPECT_GT(largest, 1e3) << "the gauge's own lever arm counts";
  EXPECT_TRUE(eventually([] { return machine_->says("frames", "every frame known"); }));
}

TEST_F(BoomTest, PublishesNoJointLoadsButTheHullWrenchWithoutJointStates) {
  ASSERT_TRUE(isWhole());
  machine_->speaking.clear();
  const ros::Time silent = machine_->last_joints + ros::Duration(kMaxAge);
  const ros::Time from = now();
  ASSERT_TRUE(machine_->workFor(0.6));
  EXPECT_TRUE(eventually([] { return machine_->says("boom", "arm_joint: 0."); }));
  EXPECT_TRUE(machine_->says("boom", "no joint loads"));
  EXPECT_TRUE(eventually([&] { return isWhole(machine_->hull, from, now()); }));
  const auto expectSilence = [&](const auto& output, const char* what) {
    EXPECT_TRUE(eventually([&] { return output.count(from, silent) + 1U >= machine_->hull.count(from, silent); }))
        << what;
    EXPECT_LE(output.last(), silent) << what;
  };
  expectSilence(machine_->loads, "joint loads"), expectSilence(machine_->arm, "wrench at the arm");
  expectSilence(machine_->vibration, "vibration");
  machine_->speaking = kJoints;
  ASSERT_TRUE(isWhole());
  const ros::Time back = now();
  ASSERT_TRUE(machine_->workFor(0.3));
  EXPECT_TRUE(eventually([&] { return isWhole(machine_->loads, back, now()); }));
  EXPECT_TRUE(eventually([] { return !machine_->says("boom", "silent"); }));
}

TEST_F(BoomTest, ABadDescriptionEndsTheNodeWithOneLine) {
  const std::string space = "/bad/hammer_loads/";
  for (const test::BadBoom& bad : test::badBooms()) {
    SCOPED_TRACE(bad.what);
    XmlRpc::XmlRpcValue shipped;
    if (!bad.key.empty()) {
      ASSERT_TRUE(ros::param::get(space + bad.key, shipped));
      const bool is_number = shipped.getType() == XmlRpc::XmlRpcValue::TypeDouble;
      if (is_number) ros::param::set(space + bad.key, std::stod(bad.value));
      if (!is_number) ros::param::set(space + bad.key, bad.value);
    }
    ros::param::set(space + "robot_description", bad.urdf);
    const test::Outcome outcome = test::runCommand("timeout 120 " HAMMER_LOADS_NODE, "__ns:=/bad");
    if (!bad.key.empty()) ros::param::set(space + bad.key, shipped);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(test::linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(bad.named), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace hammer_loads
