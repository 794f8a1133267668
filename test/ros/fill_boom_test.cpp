#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/ros/fill_messages.h"

namespace hammer_loads {
namespace {

using Names = std::vector<std::string>;
constexpr StampNs kStamp = 12345678901;
constexpr HullWrench kLoad{-900.0, 7000.0, 300.0};
const Names kFour{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};

PipelineSettings settings() {
  PipelineSettings s;
  s.boom = BoomModel::kAuto;
  s.joint_max_age = 0.2;
  s.gravity = test::kGravity;
  return s;
}

template <typename Part>
Names namesOf(const std::vector<Part>& parts) {
  Names names;
  for (const Part& part : parts) names.push_back(part.name);
  return names;
}

class Messages : public testing::Test {
 protected:
  void sample(StampNs stamp) {
    WrenchHistory step;
    step.count = 1;
    step.pieces[0] = {1e-3, kLoad, kLoad, kLoad, false, {}};
    follower_.jointStates(stamp, kFour, position_, {});
    ASSERT_FALSE(follower_.sample({stamp, kLoad}, step).fault);
  }
  const std::vector<double> position_{0.2, -0.35, 1.20, -0.85};
  BoomFollower follower_{test::shippedBoom(), settings(), 0.1975};
  JointLoads jointLoads() {
    JointLoads loads;
    prepareJointLoads(follower_.boom(), loads);
    fillJointLoads(follower_.state(), loads);
    return loads;
  }
  BoomVibration vibration() {
    BoomVibration vibration;
    prepareVibration(follower_.boom(), vibration);
    fillVibration(follower_, vibration);
    return vibration;
  }
  void SetUp() override {
    sample(kStamp - 1000000);
    sample(kStamp);
  }
};

TEST_F(Messages, HoldTheStateInItsOrder) {
  const BoomState& state = follower_.state();
  const JointLoads loads = jointLoads();
  EXPECT_EQ(loads.header.stamp.toNSec(), static_cast<std::uint64_t>(kStamp));
  EXPECT_EQ(loads.header.frame_id, "base_link");
  EXPECT_EQ(namesOf(loads.joint), kFour);
  EXPECT_EQ(namesOf(loads.cylinder), (Names{"boom_cylinder", "arm_cylinder", "hammer_cylinder"}));
  for (int j = 0; j < 4; ++j) {
    const auto i = static_cast<std::size_t>(j);
    EXPECT_EQ(loads.joint.at(i).hammer_torque, state.loads.hammer[j]);
    EXPECT_EQ(loads.joint.at(i).weight_torque, state.loads.weight[j]);
    EXPECT_EQ(loads.joint.at(i).motion_torque, state.loads.motion[j]);
    EXPECT_EQ(loads.joint.at(i).vibration_torque, state.loads.vibration[j]);
    EXPECT_EQ(loads.joint.at(i).total_torque, state.loads.total[j]);
  }
  EXPECT_NE(state.loads.vibration[1], 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(loads.cylinder[i].force, state.loads.cylinder[i].force);
    EXPECT_EQ(loads.cylinder[i].pressure, state.loads.cylinder[i].pressure);
  }
}

TEST_F(Messages, HoldTheSectionLoads) {
  const BoomState& state = follower_.state();
  SectionLoads sections;
  prepareSections(follower_.boom(), sections);
  fillSections(state, sections);
  EXPECT_EQ(namesOf(sections.section), (Names{"boom_foot", "boom_middle", "arm_middle"}));
  EXPECT_EQ(sections.section[1].load.torque.y, state.steel.section[1].torque.y());
  EXPECT_EQ(sections.section[2].load.force.x, state.steel.section[2].force.x());
  EXPECT_TRUE(std::isnan(sections.section[0].load_std[2])) << "the crank's errors are not known here";
  JointReactions reactions;
  prepareReactions(follower_.boom(), reactions);
  fillReactions(state, reactions);
  EXPECT_EQ(namesOf(reactions.joint), kFour);
  EXPECT_EQ(reactions.joint[3].load.force.z, state.steel.joint[3].force.z());
  EXPECT_EQ(namesOf(reactions.cylinder), (Names{"boom_cylinder", "arm_cylinder", "hammer_cylinder"}));
  EXPECT_EQ(reactions.cylinder[0].base_force.x, state.steel.pins[0].base.x());
  EXPECT_EQ(reactions.cylinder[2].guide_force.x, state.steel.pins[2].guide.x());
  EXPECT_NE(reactions.cylinder[2].guide_force.x, 0.0);
  EXPECT_EQ(reactions.cylinder[0].guide_force.x, 0.0);
  EXPECT_EQ(reactions.cylinder[2].rod_force.z, state.steel.pins[2].rod.z());
  EXPECT_EQ(jointLoads().cylinder[0].flags, state.cylinder_flags[0]);
  EXPECT_EQ(vibration().damping_ratio[0], 0.05);
  EXPECT_FALSE(vibration().identified);
  EXPECT_NEAR(vibration().natural_frequency_std[1], 0.15 * state.frequency[1], 1e-12);
}

TEST_F(Messages, StateTheVibrationAndTheReason) {
  const BoomVibration before = vibration();
  EXPECT_TRUE(before.compliant);
  EXPECT_TRUE(std::isnan(before.rigid_error) && std::isnan(before.pulse_length));
  EXPECT_TRUE(std::isnan(before.hold_down_factor));
  EXPECT_EQ(before.hold_down_limit, "");
  EXPECT_EQ(before.header.frame_id, "hammer_hull");

  HalfSinePulse pulse;
  pulse.amplitude = 8e3;
  pulse.frequency = 3.14159265358979323846 / 0.018;
  follower_.turnEnded(pulse, 300.0);
  sample(kStamp + 1000000);
  const BoomState& state = follower_.state();
  const BoomVibration after = vibration();
  EXPECT_EQ(after.displacement.z, state.tip.displacement[2]);
  EXPECT_EQ(after.rotation.y, state.tip.displacement[4]);
  EXPECT_EQ(after.acceleration.x, state.tip.acceleration[0]);
  ASSERT_EQ(after.natural_frequency.size(), 3U);
  EXPECT_EQ(after.natural_frequency[2], state.frequency[2]);
  EXPECT_EQ(after.reduced_mass, state.reduced.mass);
  EXPECT_EQ(after.reduced_stiffness, state.reduced.stiffness);
  EXPECT_EQ(after.rigid_error, state.choice.rigid_error);
  EXPECT_EQ(after.rigid_tolerance, 0.05);
  EXPECT_NEAR(after.pulse_length, 0.018, 1e-15);
  EXPECT_EQ(after.hold_down_factor, state.hold_down->least);
  EXPECT_EQ(after.hold_down_limit, "boom_cylinder");
}

}  // namespace
}  // namespace hammer_loads
