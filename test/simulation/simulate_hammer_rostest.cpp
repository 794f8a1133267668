#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/machine_parameters.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation {
namespace {

constexpr std::uint32_t kQueueSize = 100000;
const ros::WallDuration kDeadline(400.0);  // the machine needs 3 s
const ros::Time kStart(1700000000, 0);

const Session& expected() {
  static const Session kSession = [] {
    std::vector<std::string> problems;
    const ParameterMap given = *parameterMap(YAML::Load("{duration_s: 6.0, seed: 9, rod: rigid}"), "test", problems);
    MachineSettings machine = loadSimulator(configDirectory(), given).value.value().machine;
    machine.start_stamp = 1700000000000000000;
    return recordSession(machine);
  }();
  return kSession;
}

/// Messages on the node's topics from its start to its end.
class Heard : public testing::Environment {
 public:
  void SetUp() override {
    ros::NodeHandle node;
    const auto no_delay = ros::TransportHints().tcpNoDelay();
    diagnostics_ = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100);
    const ros::WallTime end = ros::WallTime::now() + kDeadline;
    while (diagnostics_.getNumSubscribers() == 0 && ros::WallTime::now() < end) ros::WallDuration(0.01).sleep();
    report(kStart);
    const ros::Subscriber clock_subscriber = node.subscribe("/clock", kQueueSize, &Heard::onClock, this, no_delay);
    const ros::Subscriber joint_subscriber =
        node.subscribe("joint_states", kQueueSize, &Heard::onJoints, this, no_delay);
    const ros::Subscriber crank_subscriber = node.subscribe("crank", kQueueSize, &Heard::onCrank, this, no_delay);
    while (ros::ok() && ros::WallTime::now() < end && !complete())
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }

  std::vector<sensor_msgs::JointState> cranks, joints;
  std::vector<ros::Time> clock;
  ros::Time stood;  ///< time at which the machine first paused; 0: it has not

 private:
  void report(const ros::Time& taken) {
    diagnostic_msgs::DiagnosticArray message;
    message.status.resize(1);
    message.status[0].values.resize(1);
    message.status[0].values[0].key = kLastSampleKey;
    message.status[0].values[0].value = std::to_string(taken.toNSec());
    diagnostics_.publish(message);
  }
  bool complete() const {
    return cranks.size() >= expected().crank.size() && joints.size() >= expected().joints.size() && !clock.empty() &&
           clock.back() >= ros::Time(1700000006, 0);
  }
  /// Acts as a node that processes nothing until the machine pauses.
  void onCrank(const sensor_msgs::JointState& message) {
    cranks.push_back(message);
    if (!stood.isZero()) report(message.header.stamp);
  }
  void onJoints(const sensor_msgs::JointState& message) { joints.push_back(message); }
  void onClock(const rosgraph_msgs::Clock& message) {
    const bool stands = !clock.empty() && clock.back() == message.clock && message.clock > kStart;
    clock.push_back(message.clock);
    if (!stands || !stood.isZero() || cranks.empty()) return;
    stood = message.clock;
    report(cranks.back().header.stamp);
  }

  ros::Publisher diagnostics_;
};

Heard& heard() {
  static Heard* const kHeard = new Heard;  // the environment, which gtest deletes
  return *kHeard;
}

TEST(SimulateHammer, EverySampleArrivesOnceAndInOrder) {
  ASSERT_EQ(heard().cranks.size(), expected().crank.size());
  for (std::size_t i = 0; i < heard().cranks.size(); ++i) {
    ASSERT_EQ(heard().cranks[i].header.seq, i);
    ASSERT_EQ(heard().cranks[i].header.stamp.toNSec(), static_cast<std::uint64_t>(expected().crank[i].stamp));
  }
}

/// The batches divide the integration differently, so that speeds agree only within its error.
TEST(SimulateHammer, ReadingsAreTheSessions) {
  ASSERT_EQ(heard().cranks.size(), expected().crank.size());
  std::size_t other_count = 0;
  for (std::size_t i = 0; i < heard().cranks.size(); ++i) {
    const sensor_msgs::JointState& message = heard().cranks[i];
    ASSERT_EQ(message.name, std::vector<std::string>{"hammer_crank_joint"});
    ASSERT_EQ(message.position.size(), 1U);
    ASSERT_EQ(message.velocity.size(), 1U);
    ASSERT_NEAR(message.velocity[0], *expected().crank[i].speed, 1e-3);
    if (message.position[0] != expected().crank[i].angle) ++other_count;
  }
  EXPECT_LE(other_count, heard().cranks.size() / 1000);  // angles at the edge of an encoder count
}

TEST(SimulateHammer, BoomJointsAreTheSessions) {
  ASSERT_EQ(heard().joints.size(), expected().joints.size());
  for (std::size_t i = 0; i < heard().joints.size(); ++i) {
    const sensor_msgs::JointState& message = heard().joints[i];
    const JointReading& reading = expected().joints[i];
    ASSERT_EQ(message.name, std::vector<std::string>(kBoomJoints.begin(), kBoomJoints.end()));
    ASSERT_EQ(message.header.stamp.toNSec(), static_cast<std::uint64_t>(reading.stamp));
    ASSERT_EQ(message.position, std::vector<double>(reading.position.begin(), reading.position.end()));
    ASSERT_EQ(message.velocity, std::vector<double>(reading.velocity.begin(), reading.velocity.end()));
  }
}

/// The machine pauses after two seconds at a clock_factor of 2, and a batch.
TEST(SimulateHammer, WaitsForANodeThatIsBehind) {
  ASSERT_FALSE(heard().stood.isZero());
  EXPECT_NEAR((heard().stood - kStart).toSec(), 4.0, 0.02);
}

TEST(SimulateHammer, ClockRunsForwardToTheEnd) {
  ASSERT_GT(heard().clock.size(), 100U);
  for (std::size_t i = 1; i < heard().clock.size(); ++i) ASSERT_GE(heard().clock[i], heard().clock[i - 1]);
  EXPECT_EQ(heard().clock.back(), ros::Time(1700000006, 0));
}

/// Returns exit code and output of a second simulate_hammer.
std::pair<int, std::string> runWith(const std::string& arguments) {
  const auto beside = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string command = (beside / "simulate_hammer").string() + " __name:=another " + arguments + " 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");
  std::string output;
  std::array<char, 256> part{};
  while (pipe != nullptr && std::fgets(part.data(), part.size(), pipe) != nullptr) output += part.data();
  const int status = pipe != nullptr ? pclose(pipe) : -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

TEST(SimulateHammer, BadParametersAreNamedAndEndIt) {
  const auto [code, output] = runWith("_crank_rate_Hz:=-5.0 _sed:=3");
  EXPECT_EQ(code, 1);
  EXPECT_NE(output.find("crank_rate_Hz: -5"), std::string::npos) << output;
  EXPECT_NE(output.find("sed: unknown key"), std::string::npos) << output;
}

}  // namespace
}  // namespace hammer_loads::simulation

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "simulate_hammer_rostest");
  testing::AddGlobalTestEnvironment(&hammer_loads::simulation::heard());
  return RUN_ALL_TESTS();
}
