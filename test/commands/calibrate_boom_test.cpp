// The command calibrate --boom: it reads bags and writes a boom file that every other command reads.
#include <rosbag/bag.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/JointState.h>

#include "calibration/free_boom.h"
#include "commands/bag_files.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

using test::FreeBoom;
using test::Outcome;

const std::string kBoomFiles = " --params " + test::sourceFile("config/boom_eo2621.yaml") + " --urdf " +
                               test::sourceFile("urdf/eo2621_mo100.urdf");

void writeBag(const std::string& path, const calibration::BoomRecording& recording, double unit = 1.0) {
  constexpr double kStart = 1000.0;  // [s]
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const std::array<const char*, 4> names{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};
  for (std::size_t j = 1; j < 4; ++j) {
    for (std::size_t i = 0; i < recording.joint[j].time.size(); ++i) {
      sensor_msgs::JointState message;
      message.header.stamp = ros::Time(kStart + recording.joint[j].time[i]);
      message.name = {names[j]}, message.position = {recording.joint[j].value[i]};
      bag.write("/joint_states", message.header.stamp, message);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t chamber = 0; chamber < 2; ++chamber) {
      const calibration::Trace& trace = recording.pressure[k][chamber];
      const std::string topic = std::string("/hammer/cylinder_pressures/") + simulation::kBoomCylinders[k] +
                                (chamber == 0 ? "/bore" : "/rod");
      for (std::size_t i = 0; i < trace.time.size(); ++i) {
        sensor_msgs::FluidPressure message;
        message.header.stamp = ros::Time(kStart + trace.time[i]);
        message.fluid_pressure = unit * trace.value[i];
        bag.write(topic, message.header.stamp, message);
      }
    }
  }
}

class CalibrateBoom : public test::BagFiles {
 protected:
  static Outcome calibrate(const std::string& arguments) {
    return test::runCommand(HAMMER_LOADS_CALIBRATE, "--boom " + arguments);
  }
};

TEST_F(CalibrateBoom, WritesABoomFileThatOtherCommandsRead) {
  std::mt19937 random(1);
  FreeBoom machine;
  for (auto& link : machine.chain.links) link.mass *= 1.1;  // the nominal mass is 9 % too low
  machine.friction = {0.02, 0.02, 0.02};
  writeBag(path("free.bag"), machine.record(random, 120.0));
  const std::string out = path("boom.yaml");
  const Outcome outcome = calibrate(path("free.bag") + kBoomFiles + " --write " + out);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("swing_joint: never heard"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("boom_cylinder"), std::string::npos);
  EXPECT_NE(test::contentOf(path("boom.svg")).find("</svg>"), std::string::npos);

  const Checked<Settings> settings = loadFiles(configDirectory(), {out}, test::shippedUrdf());
  ASSERT_TRUE(settings.value) << settings.problems.front();
  Boom found = *settings.value->boom, given = test::shippedBoom();
  EXPECT_EQ(found.sections().size(), given.sections().size());  // the given sections are kept
  const std::array<double, 3> q{-0.3, 1.2, -0.5}, truth = machine.staticTorque(q);
  for (Boom* boom : {&found, &given})
    boom->move({test::joints({0.0, q[0], q[1], q[2]}), test::kZero, test::kZero}, test::kLevel);
  for (int j = 1; j < 4; ++j) {
    const double right = truth[static_cast<std::size_t>(j - 1)];
    EXPECT_NEAR(found.steadyTorque(j), right, 0.04 * std::abs(right)) << j;
  }
  EXPECT_GT(std::abs(given.steadyTorque(1) - truth[0]), 0.05 * std::abs(truth[0]));
  EXPECT_NEAR(found.cylinders()[0].parameters().friction + found.cylinders()[0].parameters().friction_force / 5e4, 0.02,
              0.006);

  const std::string before = test::contentOf(out);
  EXPECT_EQ(calibrate(path("free.bag") + kBoomFiles + " --write " + out).exit_code, 1);
  EXPECT_EQ(calibrate(path("free.bag") + kBoomFiles + " --force --write " + out).exit_code, 0);
  EXPECT_EQ(test::contentOf(out), before);  // the same input gives the same bytes
}

TEST_F(CalibrateBoom, StatesTheWeightOfAKnownMass) {
  std::mt19937 random(2);
  FreeBoom machine, loaded;
  loaded.hang(500.0, {-0.2, -0.9});
  writeBag(path("free.bag"), machine.record(random, 60.0));
  writeBag(path("loaded.bag"), loaded.record(random, 40.0));
  const Outcome outcome = calibrate(path("free.bag") + kBoomFiles + " --weight 500 --at -0.2 -0.9 --weighed " +
                                    path("loaded.bag") + " --write " + path("boom.yaml"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string says = "a boom weighed without it gives ";
  const std::size_t at = outcome.out.find(says);
  ASSERT_NE(at, std::string::npos) << outcome.out;
  EXPECT_NEAR(std::stod(outcome.out.substr(at + says.size())), 500.0, 10.0);
}

TEST_F(CalibrateBoom, RefusesWhatItCannotUse) {
  std::mt19937 random(3);
  const calibration::BoomRecording recording = FreeBoom().record(random, 60.0);
  writeBag(path("bar.bag"), recording, 1e-5);
  const std::string out = " --write " + path("boom.yaml");
  const Outcome bar = calibrate(path("bar.bag") + kBoomFiles + out);
  EXPECT_EQ(bar.exit_code, 1);
  EXPECT_NE(bar.err.find("in bar"), std::string::npos) << bar.err;
  const Outcome no_boom = calibrate(path("bar.bag") + out);
  EXPECT_EQ(no_boom.exit_code, 1);
  EXPECT_NE(no_boom.err.find("cylinders: none"), std::string::npos) << no_boom.err;
  calibration::BoomRecording silent = recording;
  silent.pressure[1][0] = {};
  writeBag(path("silent.bag"), silent);
  const Outcome missing = calibrate(path("silent.bag") + kBoomFiles + out);
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("arm_cylinder/bore"), std::string::npos) << missing.err;
  EXPECT_EQ(calibrate(path("bar.bag") + kBoomFiles + out + " --weight 500").exit_code, 2);
  EXPECT_EQ(names(), (std::vector<std::string>{"bar.bag", "silent.bag"}));
}

}  // namespace
}  // namespace hammer_loads
