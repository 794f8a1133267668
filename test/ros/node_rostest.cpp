/// The live node as its users see it, run as node and as nodelet.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/Pulse.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <mutex>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "ros/eventually.h"
#include "support/known_zero.h"

namespace hammer_loads {
namespace {

using test::eventually;

sensor_msgs::JointState crankMessage(const ros::Time& stamp, double angle, double speed) {
  sensor_msgs::JointState m;
  m.header.stamp = stamp;
  m.name = {"hammer_crank_joint"};
  m.position = {angle};
  m.velocity = {speed};
  return m;
}

class NodeTest : public testing::Test {
 protected:
  NodeTest() {
    crank_ = node_.advertise<sensor_msgs::JointState>("crank", 10000);
    joints_ = node_.advertise<sensor_msgs::JointState>("joint_states", 1000);
    wrench_ = node_.subscribe<geometry_msgs::WrenchStamped>("hammer_loads/hull_wrench", 20000,
                                                            [this](const auto& m) { wrenches_.push_back(*m); });
    blow_ = node_.subscribe<Blow>("hammer_loads/blow", 100, [this](const auto& m) { blows_.push_back(*m); });
    pulse_ = node_.subscribe<Pulse>("hammer_loads/pulse", 100, [this](const auto& m) { pulses_.push_back(*m); });
    diagnostics_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, [this](const auto& m) {
      for (const auto& status : m->status) statuses_[status.name] = status;
    });
    EXPECT_TRUE(eventually([this] {
      return crank_.getNumSubscribers() > 0 && joints_.getNumSubscribers() > 0 && wrench_.getNumPublishers() > 0 &&
             blow_.getNumPublishers() > 0 && pulse_.getNumPublishers() > 0;
    })) << "the node must be there";
    // Samples of an earlier test count in the node, so stamps begin well after them.
    static double next_start = 1000.0;
    start_ = ros::Time(next_start += 1000.0);
  }

  void publishGoodSamples(int n) {
    for (int i = 0; i < n; ++i) {
      last_good_ = crankMessage(start_ + ros::Duration(time_), 5.0 * time_, 5.0);
      crank_.publish(last_good_);
      time_ += 1e-3;
    }
  }

  /// After a machine at work has stopped sending samples, it is accepted again only after some samples.
  void settle() {
    publishGoodSamples(100);
    const ros::Time last = start_ + ros::Duration(time_ - 1e-3);
    ASSERT_TRUE(eventually([&] { return !wrenches_.empty() && wrenches_.back().header.stamp == last; }));
  }

  /// Publishes n samples of steady rotation after `start_` and waits for a wrench of each.
  ::testing::AssertionResult goodSamplesPass(int n) {
    const std::size_t before = wrenches_.size();
    publishGoodSamples(n);
    if (!eventually([&] { return wrenches_.size() >= before + static_cast<std::size_t>(n); }))
      return ::testing::AssertionFailure() << wrenches_.size() - before << " of " << n << " wrenches";
    return ::testing::AssertionSuccess();
  }

  bool pitchIsKnown() const {
    for (const auto& [name, status] : statuses_) {
      if (name.find("hull pitch") != std::string::npos) return status.message == "known";
    }
    return false;
  }

  bool crankError(const std::string& words) const {
    return std::any_of(statuses_.begin(), statuses_.end(), [&](const auto& entry) {
      const auto& [name, status] = entry;
      return name.find("crank") != std::string::npos && status.level == diagnostic_msgs::DiagnosticStatus::ERROR &&
             status.message.find(words) != std::string::npos;
    });
  }

  std::string diagnostic(const std::string& key, const std::string& part = "crank") {
    for (const auto& [name, status] : statuses_) {
      if (name.find(part) == std::string::npos) continue;
      for (const auto& value : status.values) {
        if (value.key == key) return value.value;
      }
    }
    return {};
  }

  ros::NodeHandle node_;
  ros::Publisher crank_, joints_;
  ros::Subscriber wrench_, blow_, pulse_, diagnostics_;
  std::vector<geometry_msgs::WrenchStamped> wrenches_;
  std::vector<Blow> blows_;
  std::vector<Pulse> pulses_;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> statuses_;
  ros::Time start_;
  double time_{};
  sensor_msgs::JointState last_good_;
};

TEST_F(NodeTest, GivesOneWrenchPerSampleWithItsStampAndThePipelinesValue) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 4.0;
  machine.start_stamp = static_cast<std::int64_t>(start_.toNSec());
  Settings settings = *loadFiles(configDirectory(), {}).value;
  settings.pipeline.crank_zero_std = kKnownZeroStd;  // as in the node
  machine.hammer = settings.mechanism.parameters();
  machine.level = settings.pipeline.level;
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(settings.mechanism, settings.pipeline);
  std::vector<std::string> names(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
  sensor_msgs::JointState joints;
  joints.name = names;
  joints.position = {0.1, 0.2, 0.3, -0.35};
  joints_.publish(joints);
  pipeline.boomJoints(0, names, joints.position, {});
  ASSERT_TRUE(eventually([&] { return pitchIsKnown(); })) << "the joint states must be there before the first sample";
  std::vector<SampleResult> expected;
  std::size_t blows = 0;
  for (const auto& reading : session.crank) {
    ros::Time stamp;
    stamp.fromNSec(static_cast<std::uint64_t>(reading.stamp));
    crank_.publish(crankMessage(stamp, reading.angle, *reading.speed));
    const SampleResult& result = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    blows += result.turn_ends;
    if (result.isPublished()) expected.push_back(result);  // none next to a blow
  }
  ASSERT_TRUE(eventually([&] {
    return wrenches_.size() >= expected.size() && blows_.size() >= blows && pulses_.size() + 1 >= blows;
  })) << wrenches_.size()
      << " of " << expected.size();
  ASSERT_EQ(wrenches_.size(), expected.size());
  ASSERT_GT(expected.size(), 0.99 * static_cast<double>(session.crank.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(static_cast<StampNs>(wrenches_[i].header.stamp.toNSec()), expected[i].stamp);
    ASSERT_EQ(wrenches_[i].header.frame_id, "hammer_hull");
    ASSERT_EQ(wrenches_[i].wrench.force.x, expected[i].wrench.force_x) << i;
    ASSERT_EQ(wrenches_[i].wrench.force.z, expected[i].wrench.force_z) << i;
    ASSERT_EQ(wrenches_[i].wrench.torque.y, expected[i].wrench.torque_y) << i;
    ASSERT_EQ(wrenches_[i].wrench.force.y, 0.0);
  }
  EXPECT_GE(blows, 5u);
  EXPECT_EQ(blows_.size(), blows);
  EXPECT_EQ(pulses_.size(), blows - 1) << "the first blow ends no whole turn";
  EXPECT_GT(pulses_.back().amplitude, 5000.0);
  EXPECT_NEAR(blows_.back().energy, session.blows.back().strike.energy, 0.02 * blows_.back().energy);
  EXPECT_GT(blows_.back().mean_hold_down_force, 500.0);
  EXPECT_TRUE(eventually([&] { return diagnostic("blank firing, per hour", "misuse") == "0"; }));
  EXPECT_EQ(diagnostic("blows without hold-down force on the rock", "misuse"), "not known: needs cylinder pressures");
}

TEST_F(NodeTest, RefusesEachBadSampleCountsItAndTakesTheNextGoodOne) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto at = [&](double time) { return start_ + ros::Duration(time); };
  sensor_msgs::JointState foreign = crankMessage(at(0), 0, 0), bare = foreign;
  foreign.name = {"wheel"};
  bare.position.clear();
  const std::vector<std::pair<std::string, std::function<sensor_msgs::JointState()>>> bad{
      {"not finite", [&] { return crankMessage(at(time_), kNan, 5.0); }},
      {"implausible", [&] { return crankMessage(at(time_), 5.0 * time_, 1e6); }},
      {"out of order", [&] { return crankMessage(at(time_ - 0.5), 5.0 * time_, 5.0); }},  // later than stale_after_s
      {"duplicate", [&] { return last_good_; }},
      {"missing joint", [&] { return foreign; }},
      {"short array", [&] { return bare; }}};
  settle();
  for (const auto& [reason, message] : bad) {
    SCOPED_TRACE(reason);
    ASSERT_TRUE(goodSamplesPass(20));
    const std::string key = "refused: " + reason;
    ASSERT_TRUE(eventually([&] { return !diagnostic(key).empty(); }));
    const auto count = std::stoul(diagnostic(key));
    const std::size_t before = wrenches_.size();
    crank_.publish(message());
    EXPECT_TRUE(eventually([&] { return std::stoul(diagnostic(key)) == count + 1; }));
    EXPECT_EQ(wrenches_.size(), before);
    ASSERT_TRUE(goodSamplesPass(20));
  }
}

TEST_F(NodeTest, ReportsAStaleCrankAndGoesOnWhenItIsBack) {
  settle();
  ASSERT_TRUE(goodSamplesPass(20));
  EXPECT_TRUE(eventually([this] { return crankError("stale"); }));
  time_ += 10.0;
  settle();
  const std::size_t before = wrenches_.size();
  ASSERT_TRUE(goodSamplesPass(20));
  EXPECT_EQ(wrenches_.size(), before + 20);
  statuses_.clear();
  EXPECT_TRUE(eventually([&] { return !statuses_.empty(); }));
}

}  // namespace
}  // namespace hammer_loads
