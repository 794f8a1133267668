/// process_bag with a robot description, as its user runs it, on bags written here.
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <filesystem>
#include <map>

#include "commands/recording_sink.h"
#include "hammer_loads/bench/signal_error.h"
#include "hammer_loads/ros/stamp.h"
#include "support/command.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

constexpr double kGravity = 9.80665;
constexpr double kSide = 0.8;  // [m] from arm_link back to the strain gauge
const std::string kUrdf = test::sourceFile("urdf/eo2621_mo100.urdf");
const std::string kBoomFile = configDirectory() + "/boom_eo2621.yaml";

/// Two and a half seconds of a machine that soon strikes; `moving`: its boom moves as well.
simulation::MachineSettings machine(bool moving) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 2.5;
  machine.drive.start_time = 0.1;
  machine.drive.start_ramp = 0.2;
  for (simulation::JointMotion& joint : machine.boom) joint.amplitude *= moving ? 1.0 : 0.0;
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

/// Inputs of a session as they would be recorded, 2 ms late.
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

class BoomBag : public testing::Test {
 protected:
  BoomBag() : directory_(fs::temp_directory_path() / ("boom_bag_test_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
  }
  ~BoomBag() override { fs::remove_all(directory_); }
  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  test::Outcome process(const std::string& out, const std::string& parameters, const std::string& more = {}) const {
    const test::TemporaryFile given(parameters);
    return test::runCommand(HAMMER_LOADS_PROCESS_BAG, path("in.bag") + " " + path(out) + " --pins --urdf " + kUrdf +
                                                          " --params " + kBoomFile + " --params " + given.path() + " " +
                                                          more);
  }
  /// What the live node's flow makes of the same messages.
  test::Recorded live(const std::string& parameters, const std::string& imu_topic = {}) const {
    const test::TemporaryFile given(parameters);
    const Settings settings = *loadFiles(configDirectory(), {kBoomFile, given.path()}, test::textOf(kUrdf)).value;
    const InputTopics topics{"/hammer/crank", "/joint_states", imu_topic.empty() ? "/hammer/hull_imu" : imu_topic,
                             "/hammer/cylinder_pressures"};
    return test::recordedLive(path("in.bag"), withInputTopics(settings, topics), imu_topic);
  }

  fs::path directory_;
};

std::map<std::string, std::size_t> countsOf(const test::Recorded& recorded) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [topic, messages] : recorded) counts[topic] = messages.size();
  return counts;
}

TEST_F(BoomBag, HoldsEveryOutputAsTheLiveFlowGivesItAndIsByteIdenticalOnASecondRun) {
  const simulation::Session session = simulation::recordSession(machine(true));
  InputBag(path("in.bag"), session);
  // The session's hull stands still: the model's motion and the drive's reaction together would contradict it.
  const std::string parameters =
      "boom_wrench_links: [arm_link, strain_gauge]\nboom: compliant\nhull_motion: model\ndrive_reaction_ratio: 0.0\n";
  const test::Outcome outcome = process("out.bag", parameters);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const test::Recorded written = test::recordedIn(path("out.bag"));
  auto counts = countsOf(written);
  const std::size_t samples = session.crank.size();
  // Before the first joint states and beyond the last transform nothing is known: 20 ms at most each.
  for (const char* topic : {"boom_wrench/arm_link", "joint_loads", "section_loads", "joint_reactions", "boom_vibration",
                            "boom_wrench/strain_gauge"}) {
    EXPECT_GE(counts[topic], samples - 40) << topic;
    EXPECT_LT(counts[topic], samples) << topic;
  }
  for (const char* topic : {"hull_wrench", "hull_loads", "mechanism", "pin_forces"}) EXPECT_EQ(counts[topic], samples);
  EXPECT_GE(counts["blow"], 8U);
  EXPECT_EQ(counts["pulse"], counts["blow"] - 1);
  EXPECT_EQ(counts["run_info"], 1U);
  EXPECT_EQ(counts.size(), 15U);

  const test::Recorded right = live(parameters);
  EXPECT_EQ(countsOf(right), counts);
  EXPECT_TRUE(written == right);

  ASSERT_EQ(process("again.bag", parameters).exit_code, 0);
  const std::string bytes = test::contentOf(path("out.bag"));
  EXPECT_GT(bytes.size(), 1000000U);
  EXPECT_TRUE(bytes == test::contentOf(path("again.bag")));
}

/// By hand: from the gauge's frame to D, on the hammer joint's angle between its two states.
TEST_F(BoomBag, TellsTheLoadAtATfFrameWithItsLeverArm) {
  const simulation::Session session = simulation::recordSession(machine(true));
  InputBag(path("in.bag"), session);
  ASSERT_EQ(process("out.bag", "boom_wrench_links: [strain_gauge]\n").exit_code, 0);
  const auto hull = test::wrenchesIn(path("out.bag"), "/hammer_loads/hull_wrench");
  const auto gauge = test::wrenchesIn(path("out.bag"), "/hammer_loads/boom_wrench/strain_gauge");
  ASSERT_GT(gauge.size(), 2400U);
  double largest = 0.0;
  std::size_t next = 1;
  for (const auto& [stamp, told] : gauge) {
    while (next + 1 < session.joints.size() && session.joints[next].stamp < stamp) ++next;
    const simulation::JointReading &before = session.joints[next - 1], &after = session.joints[next];
    const double part = static_cast<double>(stamp - before.stamp) / static_cast<double>(after.stamp - before.stamp);
    const double angle = before.position[3] + part * (after.position[3] - before.position[3]);
    const double c = std::cos(angle), s = std::sin(angle);
    const geometry_msgs::Wrench& w = hull.at(stamp);
    const double force_x = c * w.force.x + s * w.force.z, force_z = -s * w.force.x + c * w.force.z;
    const double x = kSide + 1.70 + 0.10 * c - 0.55 * s, z = -0.10 * s - 0.55 * c;
    const double torque = w.torque.y + z * force_x - x * force_z;
    // Slerp of half angles 0.02 rad apart and quaternions that TF rounds: 1e-12 of the load.
    ASSERT_NEAR(told.force.x, force_x, 1e-8) << stamp;
    ASSERT_NEAR(told.force.z, force_z, 1e-8) << stamp;
    ASSERT_NEAR(told.torque.y, torque, 1e-8) << stamp;
    largest = std::max(largest, std::abs(torque));
  }
  EXPECT_GT(largest, 1e4) << "some 8 kN at some 2.5 m";
}

TEST_F(BoomBag, ReadsTheHullsImu) {
  const simulation::Session session = simulation::recordSession(machine(false));
  const auto& q = session.joints.front().position;
  const double pitch = q[1] + q[2] + q[3];
  {
    InputBag in(path("in.bag"), session);
    const ImuReading reading = test::atRest(pitch, {});
    for (int i = -2; i < 510; ++i) in.writeImu(timeOf(machine(false).start_stamp) + ros::Duration(0.005 * i), reading);
  }
  const std::string links = "boom_wrench_links: [arm_link, strain_gauge]\n", imu = links + "hull_motion: imu\n";
  ASSERT_EQ(process("out.bag", imu, "--imu-topic /machine/imu").exit_code, 0);
  ASSERT_EQ(process("again.bag", imu, "--imu-topic /machine/imu").exit_code, 0);
  EXPECT_TRUE(test::contentOf(path("out.bag")) == test::contentOf(path("again.bag")));
  const test::Recorded written = test::recordedIn(path("out.bag"));
  EXPECT_EQ(written.size(), 15U);
  EXPECT_TRUE(written == live(imu, "/machine/imu"));

  // At rest it says what pitch says, but from the first sample on: compared once the pitch joints have been heard too.
  ASSERT_EQ(process("fixed.bag", links + format("hull_pitch_rad: %.17g\n", pitch)).exit_code, 0);
  const auto measured = test::wrenchesIn(path("out.bag"), "/hammer_loads/hull_wrench");
  const auto fixed = test::wrenchesIn(path("fixed.bag"), "/hammer_loads/hull_wrench");
  ASSERT_EQ(measured.size(), fixed.size());
  for (const auto& [stamp, wrench] : measured) {
    ASSERT_NEAR(wrench.force.x, fixed.at(stamp).force.x, 1e-9 * 8e3) << stamp;
    ASSERT_NEAR(wrench.force.z, fixed.at(stamp).force.z, 1e-9 * 8e3) << stamp;
  }
  const auto loads = test::messagesIn<HullLoads>(path("out.bag"), "/hammer_loads/hull_loads");
  for (const HullLoads& m : loads) ASSERT_TRUE(m.flags & HullLoads::FLAG_HULL_MOTION) << m.header.stamp;
}

TEST_F(BoomBag, ReadsTheCylindersPressures) {
  const simulation::Session session = simulation::recordSession(machine(false));
  { InputBag(path("in.bag"), session); }
  ASSERT_EQ(process("without.bag", "boom: compliant\n").exit_code, 0);
  const auto without = test::messagesIn<JointLoads>(path("without.bag"), "/hammer_loads/joint_loads");
  // What holds the boom as its model has it, a tenth more in one cylinder: other pressures would not be believed.
  constexpr double kRod = 2e6, kMore = 1.1;
  const struct {
    const char* name;
    double bore, rod;  // diameters
  } cylinders[]{{"boom_cylinder", 0.110, 0.063}, {"arm_cylinder", 0.100, 0.056}, {"hammer_cylinder", 0.080, 0.050}};
  {
    InputBag in(path("in.bag"), session);
    for (std::size_t i = 0; i < without.size(); i += 2) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double area = 0.25 * kPi * cylinders[k].bore * cylinders[k].bore;
        const double rod_area = area - 0.25 * kPi * cylinders[k].rod * cylinders[k].rod;
        const double force = (k == 2 ? kMore : 1.0) * without[i].cylinder_force_N[k];
        in.writePressures(without[i].header.stamp, cylinders[k].name, (force + kRod * rod_area) / area, kRod);
      }
    }
  }
  const test::Outcome outcome = process("with.bag", "boom: compliant\n", "--pressures-topic /machine/oil");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto with = test::messagesIn<JointLoads>(path("with.bag"), "/hammer_loads/joint_loads");
  ASSERT_EQ(with.size(), without.size());
  accuracy::SignalError hammer_cylinder;
  for (std::size_t i = 5; i < with.size(); ++i) {
    ASSERT_TRUE(with[i].flags & JointLoads::FLAG_MEASURED) << i;
    ASSERT_FALSE(without[i].flags & JointLoads::FLAG_MEASURED);
    hammer_cylinder.add(with[i].cylinder_force_N[2], kMore * without[i].cylinder_force_N[2]);
    for (std::size_t j = 0; j < 4; ++j) {
      const double model = with[i].hammer_torque_Nm[j] + with[i].weight_torque_Nm[j] + with[i].motion_torque_Nm[j] +
                           with[i].vibration_torque_Nm[j];
      ASSERT_NEAR(with[i].total_torque_Nm[j], model + with[i].contact_torque_Nm[j], 1e-6);
      ASSERT_EQ(without[i].contact_torque_Nm[j], 0.0);
    }
  }
  EXPECT_LT(hammer_cylinder.rms(), 0.2 * (kMore - 1.0));
}

/// Oil 30 % softer than the boom file says, known by every sensor; against the machine's own equations.
TEST_F(BoomBag, TellsWhatTheSteelOfAMachineOnSofterOilCarries) {
  simulation::MachineSettings m = machine(true);
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
  for (const SectionLoads& loads : test::messagesIn<SectionLoads>(path("out.bag"), "/hammer_loads/section_loads")) {
    const StampNs stamp = stampOf(loads.header.stamp);
    for (std::size_t i = 0; stamp > from && i < 3; ++i)
      section[i].add(loads.load[i].torque.y, truth.at(stamp)->cut[i].torque_y);
  }
  for (const JointLoads& loads : test::messagesIn<JointLoads>(path("out.bag"), "/hammer_loads/joint_loads")) {
    const StampNs stamp = stampOf(loads.header.stamp);
    for (std::size_t i = 0; stamp > from && i < 3; ++i) {
      const double weight = loads.weight_torque_Nm[i + 1];
      torque[i].add(loads.total_torque_Nm[i + 1] - weight, -truth.at(stamp)->hold[static_cast<int>(i)] - weight);
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
}  // namespace hammer_loads
