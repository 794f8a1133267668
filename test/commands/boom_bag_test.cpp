/// process_bag with a robot description, run as a command on bags written here. Its outputs are compared with the live
/// node's and, with sensors on hull and cylinders, with the machine's own equations.
#include <ros/serialization.h>
#include <sensor_msgs/FluidPressure.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <utility>

#include "commands/bag_files.h"
#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/ros/stamp.h"
#include "support/known_zero.h"
#include "support/session_player.h"

namespace hammer_loads::test {
namespace {

/// Record time and content of each message, by topic without its prefix.
using Recorded = std::map<std::string, std::vector<std::pair<ros::Time, std::vector<std::uint8_t>>>>;

Recorded recordedIn(const std::string& path) {
  const std::string prefix = "/hammer_loads/";
  Recorded recorded;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    std::vector<std::uint8_t> bytes(item.size());
    ros::serialization::OStream stream(bytes.data(), item.size());
    item.write(stream);
    recorded[item.getTopic().substr(prefix.size())].emplace_back(item.getTime(), std::move(bytes));
  }
  return recorded;
}

/// Passes a bag's messages through a HammerBridge as the node does; topics without a message are left out.
Recorded recordedLive(const std::string& path, const Settings& settings) {
  Recorded recorded;
  HammerBridge flow(settings);
  flow.outputs().forEach([&](auto& output) {
    output.attach([&messages = recorded[output.name()]](const auto& message, const ros::Time& time) {
      std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
      ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      ros::serialization::serialize(stream, message);
      messages.emplace_back(time, std::move(bytes));
    });
  });
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    const std::string topic = item.getTopic();
    const ros::Time time = item.getTime();
    if (topic == "/hammer/crank") flow.crank(*item.instantiate<sensor_msgs::JointState>(), time);
    if (topic == "/joint_states") flow.jointStates(*item.instantiate<sensor_msgs::JointState>(), time);
    if (topic == "/tf" || topic == "/tf_static")
      flow.transforms(*item.instantiate<tf2_msgs::TFMessage>(), topic == "/tf_static", time);
  }
  flow.finishRun();
  for (auto topic = recorded.begin(); topic != recorded.end();)
    topic = topic->second.empty() ? recorded.erase(topic) : std::next(topic);
  return recorded;
}

template <typename Message>
std::vector<Message> messagesIn(const std::string& path, const std::string& topic) {
  std::vector<Message> messages;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag, rosbag::TopicQuery(topic)))
    messages.push_back(*item.instantiate<Message>());
  return messages;
}

constexpr double kSide = 0.8;  // [m] from arm_link back to the strain gauge
const std::string kUrdf = sourceFile("urdf/eo2621_mo100.urdf");
/// The encoder's zero is known as after `calibrate`. Otherwise samples of the first revolutions are withheld.
const std::string kCalibrated = kKnownZeroYaml;
const std::string kBoomFile = configDirectory() + "/boom_eo2621.yaml";

/// Returns a machine that soon strikes and moves its boom, for 2.5 s.
simulation::MachineSettings machineOfBag() {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 2.5;
  machine.drive.start_time = 0.1;
  machine.drive.start_ramp = 0.2;
  return machine;
}

geometry_msgs::TransformStamped transform(const ros::Time& stamp, const std::string& parent, const std::string& child,
                                          double x, double z, double pitch = 0.0) {
  geometry_msgs::TransformStamped t;
  t.header.stamp = stamp;
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.transform.translation.x = x;
  t.transform.translation.z = z;
  t.transform.rotation.y = std::sin(0.5 * pitch);
  t.transform.rotation.w = std::cos(0.5 * pitch);
  return t;
}

/// Writes the inputs of a session as they would be recorded, 2 ms late.
class InputBag {
 public:
  InputBag(const std::string& path, const simulation::Session& session) : bag_(path, rosbag::bagmode::Write) {
    writeStatic(session.joints.front().stamp);
    for (const simulation::JointReading& reading : session.joints) writeJoints(reading);
    for (const simulation::CrankReading& reading : session.crank) {
      sensor_msgs::JointState m;
      m.header.stamp = timeOf(reading.stamp);
      m.name = {"hammer_crank_joint"};
      m.position = {reading.angle};
      m.velocity = {*reading.speed};
      write("/hammer/crank", m.header.stamp, m);
    }
  }
  void writePressures(const ros::Time& stamp, const std::string& cylinder, double bore, double rod) {
    sensor_msgs::FluidPressure m;
    m.header.stamp = stamp;
    m.fluid_pressure = bore;
    write("/machine/oil/" + cylinder + "/bore", stamp, m);
    m.fluid_pressure = rod;
    write("/machine/oil/" + cylinder + "/rod", stamp, m);
  }
  void writeImu(const ros::Time& stamp, const ImuReading& reading) {
    sensor_msgs::Imu m;
    m.header.stamp = stamp;
    m.linear_acceleration.x = reading.specific_force.x();
    m.linear_acceleration.y = reading.specific_force.y();
    m.linear_acceleration.z = reading.specific_force.z();
    m.angular_velocity.y = reading.rate.y();
    write("/machine/imu", stamp, m);
  }

 private:
  template <typename Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    bag_.write(topic, stamp + ros::Duration(0.002), message);
  }
  void writeStatic(StampNs first) {
    tf2_msgs::TFMessage m;
    m.transforms = {transform({}, "hammer_link", "hammer_hull", 0.10, -0.55),
                    transform({}, "arm_link", "strain_gauge", -kSide, 0.0)};
    write("/tf_static", timeOf(first), m);
  }
  void writeJoints(const simulation::JointReading& reading) {
    sensor_msgs::JointState joints;
    joints.header.stamp = timeOf(reading.stamp);
    joints.name.assign(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
    joints.position.assign(reading.position.begin(), reading.position.end());
    joints.velocity.assign(reading.velocity.begin(), reading.velocity.end());
    write("/joint_states", joints.header.stamp, joints);
    tf2_msgs::TFMessage m;
    m.transforms = {transform(joints.header.stamp, "arm_link", "hammer_link", 1.70, 0.0, reading.position[3])};
    write("/tf", joints.header.stamp, m);
  }

  rosbag::Bag bag_;
};

class BoomBag : public BagFiles {
 protected:
  Outcome process(const std::string& out, const std::string& parameters, const std::string& more = {}) const {
    const TemporaryFile given(kCalibrated + parameters);
    return runCommand(HAMMER_LOADS_PROCESS_BAG, path("in.bag") + " " + path(out) + " --pins --urdf " + kUrdf +
                                                    " --params " + kBoomFile + " --params " + given.path() + " " +
                                                    more);
  }
  /// Returns the live node's outputs for the same messages.
  Recorded live(const std::string& parameters) const {
    const TemporaryFile given(kCalibrated + parameters);
    const Settings settings = *loadFiles(configDirectory(), {kBoomFile, given.path()}, textOf(kUrdf)).value;
    const InputTopics topics{"/hammer/crank", "/joint_states", "/hammer/hull_imu", "/hammer/cylinder_pressures",
                             "/hammer/reference"};
    return recordedLive(path("in.bag"), withInputTopics(settings, topics));
  }
};

std::map<std::string, std::size_t> countsOf(const Recorded& recorded) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [topic, messages] : recorded) counts[topic] = messages.size();
  return counts;
}

TEST_F(BoomBag, HoldsEveryOutputAsTheLiveFlowGivesItAndIsByteIdenticalOnASecondRun) {
  const simulation::Session session = simulation::recordSession(machineOfBag());
  InputBag(path("in.bag"), session);
  // The session's hull stands still: the model's motion and the drive's reaction together would contradict it.
  const std::string parameters =
      "boom_wrench_links: [arm_link, strain_gauge]\nboom: compliant\nhull_motion: model\ndrive_reaction_ratio: 0.0\n";
  const test::Outcome outcome = process("out.bag", parameters);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Recorded written = recordedIn(path("out.bag"));
  auto counts = countsOf(written);
  const std::size_t samples = session.crank.size();
  // Before the first joint states and beyond the last transform nothing is known: 20 ms at most each. Beside a blow
  // nothing is published: in the first turns of these 2.5 s the zero is not known.
  const std::size_t beside = samples / 50;
  for (const char* topic : {"boom_wrench/arm_link", "joint_loads", "section_loads", "joint_reactions", "boom_vibration",
                            "boom_wrench/strain_gauge"}) {
    EXPECT_GE(counts[topic], samples - 40 - beside) << topic;
    EXPECT_LT(counts[topic], samples) << topic;
  }
  EXPECT_GE(counts["hull_wrench"], samples - beside);
  for (const char* topic : {"hull_loads", "pin_forces"}) EXPECT_EQ(counts[topic], counts["hull_wrench"]);
  EXPECT_LE(counts["mechanism"], samples / 10 + 1) << "at most 100 Hz";
  EXPECT_GE(counts["mechanism"], (samples - 10 * beside) / 10);
  EXPECT_GE(counts["blow"], 8U);
  EXPECT_EQ(counts["pulse"], counts["blow"] - 1);
  EXPECT_EQ(counts["run_info"], 1U);
  EXPECT_EQ(counts.size(), 15U);

  const Recorded right = live(parameters);
  EXPECT_EQ(countsOf(right), counts);
  EXPECT_TRUE(written == right);

  ASSERT_EQ(process("again.bag", parameters).exit_code, 0);
  const std::string bytes = test::contentOf(path("out.bag"));
  EXPECT_GT(bytes.size(), 1000000U);
  EXPECT_TRUE(bytes == test::contentOf(path("again.bag")));
}

TEST_F(BoomBag, RefusesABadDescriptionOrBoomFileInOneLineAndWritesNothing) {
  const std::string files = copy(kSession, "in.bag") + " " + path("out.bag") + " --params " + kBoomFile + " --urdf ";
  const TemporaryFile cut("<robot name=\"cut\"><link", ".urdf"), empty({}, ".urdf");
  const TemporaryFile joint("hammer_cylinder_joint: hammer_crank_joint\n");
  expectRefused(run(files + cut.path()), {"robot_description: cannot be read"});
  expectRefused(run(files + empty.path()), {empty.path() + ": cannot be read: is empty"});
  expectRefused(run(files + "/no/such.urdf"), {"/no/such.urdf: cannot be read: No such file or directory"});
  expectRefused(run(files + kUrdf + " --params " + joint.path()), {"hammer_cylinder_joint: hammer_crank_joint"});
  EXPECT_EQ(names(), std::vector<std::string>{"in.bag"});
}

/// Oil 30 % softer than in the boom file, with all sensors in use, compared with the machine's own equations.
TEST_F(BoomBag, StatesTheSectionLoadsOfAMachineOnSofterOil) {
  simulation::MachineSettings m = machineOfBag();
  m.duration = 7.0, m.drive.stop_time = 1e9;
  m.hammer.drive_reaction_ratio = 1.0;
  m.on_boom.on = true, m.on_boom.oil_stiffness = 0.7;
  m.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
  m.on_boom.pressures = {250.0, 2e4, 6e6};
  const simulation::Session session = simulation::recordSession(m);
  {
    InputBag in(path("in.bag"), session);
    for (const simulation::HullImuReading& imu : session.imu)
      in.writeImu(timeOf(imu.stamp), {Eigen::Vector3d(imu.specific_force.data()), Eigen::Vector3d(imu.rate.data())});
    for (const simulation::PressureReading& p : session.pressures)
      for (std::size_t i = 0; i < 3; ++i)
        in.writePressures(timeOf(p.stamp), simulation::kBoomCylinders[i], p.bore[i], p.rod[i]);
  }
  const test::Outcome outcome = process("out.bag", "boom: compliant\nhull_motion: imu\nboom_stiffness: identified\n",
                                        "--imu-topic /machine/imu --pressures-topic /machine/oil");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::map<StampNs, const simulation::OnBoomTruth*> truth;
  for (std::size_t i = 0; i < session.crank.size(); ++i) truth[session.crank[i].stamp] = &session.on_boom[i];
  const StampNs from = m.start_stamp + 4000000000;
  accuracy::SignalError section[3], torque[3];
  for (const SectionLoads& loads : messagesIn<SectionLoads>(path("out.bag"), "/hammer_loads/section_loads")) {
    const StampNs stamp = stampOf(loads.header.stamp);
    for (std::size_t i = 0; stamp > from && i < 3; ++i)
      section[i].add(loads.section[i].load.torque.y, truth.at(stamp)->cut[i].torque_y);
  }
  for (const JointLoads& loads : messagesIn<JointLoads>(path("out.bag"), "/hammer_loads/joint_loads")) {
    const StampNs stamp = stampOf(loads.header.stamp);
    for (std::size_t i = 0; stamp > from && i < 3; ++i) {
      const double weight = loads.joint[i + 1].weight_torque;
      torque[i].add(loads.joint[i + 1].total_torque - weight, -truth.at(stamp)->hold[static_cast<int>(i)] - weight);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::printf("section %.2f %% of its range, joint torque %.2f %% rms\n", 100 * section[i].rmsOfRange(),
                100 * torque[i].rms());
    EXPECT_GT(section[i].count, 2900);
    EXPECT_LT(section[i].rmsOfRange(), 0.04);
    EXPECT_GT(section[i].correlation(), 0.99);
    EXPECT_LT(torque[i].rms(), 0.05);
  }
}

}  // namespace
}  // namespace hammer_loads::test
