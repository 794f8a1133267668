/// The command process_grapple on bags written here.
#include "commands/bag_files.h"
#include "grapple/grapples.h"
#include "ros/grapple_messages.h"

namespace hammer_loads {
namespace {

constexpr int kSamples = 400;

double sliderAt(int i) { return 0.332 + 0.3 * std::sin(0.02 * i); }

class GrappleBag : public test::BagFiles {
 protected:
  /// Writes 100 Hz samples with record times 5 ms late; sample `bad` lies beyond the fold.
  std::string writeBag(const std::string& name, const std::string& topic, int bad = -1) const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    for (int i = 0; i < kSamples; ++i) {
      const ros::Time stamp(100.0 + 0.01 * i);
      const double slider = i == bad ? 0.74 : sliderAt(i);
      bag.write(topic, stamp + ros::Duration(0.005), test::sliderMessage(stamp, slider, 0.1));
    }
    return path(name);
  }
  static test::Outcome run(const std::string& arguments) {
    return test::runCommand(HAMMER_LOADS_PROCESS_GRAPPLE, arguments);
  }
  static std::map<std::string, std::size_t> counts(const std::string& path) {
    rosbag::Bag bag(path);
    std::map<std::string, std::size_t> counts;
    for (const rosbag::MessageInstance& item : rosbag::View(bag)) ++counts[item.getTopic()];
    return counts;
  }

  const std::string grapple_ = "--params " + test::claimsFile();
};

TEST_F(GrappleBag, WritesBothJawsAtTheRecordTimeOfTheirInput) {
  const test::Outcome outcome = run(writeBag("in.bag", "/joint_states") + " " + path("out.bag") + " " + grapple_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto written = counts(path("out.bag"));
  for (const char* topic : {"left", "left_twist", "left_accel", "right", "right_twist", "right_accel"})
    EXPECT_EQ(written.at(std::string("/grapple/jaw_edge/") + topic), kSamples) << topic;
  EXPECT_EQ(written.at("/grapple/mechanism"), kSamples);
  EXPECT_EQ(written.at("/grapple/run_info"), 1u);
  EXPECT_EQ(written.size(), 8u) << "nothing of the hammer";
  rosbag::Bag bag(path("out.bag"));
  const Grapple grapple = test::grappleOf(test::claimsParameters());
  int i = 0;
  for (const rosbag::MessageInstance& item : rosbag::View(bag, rosbag::TopicQuery("/grapple/jaw_edge/right"))) {
    const auto edge = item.instantiate<geometry_msgs::PointStamped>();
    ASSERT_EQ(edge->header.stamp, ros::Time(100.0 + 0.01 * i));
    ASSERT_EQ(item.getTime(), edge->header.stamp + ros::Duration(0.005));
    ASSERT_NEAR(edge->point.x, grapple.at(sliderAt(i))->p.re, 1e-13);  // cold and warm start differ by rounding
    ++i;
  }
}

TEST_F(GrappleBag, ReportsRefusedSamplesWithTheLimit) {
  const test::Outcome outcome = run(writeBag("in.bag", "/joint_states", 200) + " " + path("out.bag") + " " + grapple_);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err,
            "slider samples without a jaw edge, across fold: 1; the last one: grapple_slider_joint: 0.74 m, across "
            "fold: must lie between the dead centre at -0.27 m and the fold at 0.7331923934967 m\n");
  EXPECT_EQ(counts(path("out.bag")).at("/grapple/jaw_edge/left"), kSamples - 1u);
}

TEST_F(GrappleBag, TopicAndPrefixCanBeGiven) {
  const std::string in = writeBag("in.bag", "/machine/joints");
  const test::Outcome missing = run(in + " " + path("out.bag") + " " + grapple_);
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_EQ(missing.err,
            in + ": no topic /joint_states, is required; topics there: /machine/joints (sensor_msgs/JointState)\n");
  EXPECT_EQ(names().size(), 1U);
  ASSERT_EQ(
      run(in + " " + path("out.bag") + " " + grapple_ + " --joint-states-topic /machine/joints --output-prefix /claw")
          .exit_code,
      0);
  EXPECT_EQ(counts(path("out.bag")).at("/claw/jaw_edge/right_accel"), kSamples);
}

}  // namespace
}  // namespace hammer_loads
