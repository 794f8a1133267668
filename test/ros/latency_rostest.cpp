/// Time from publishing a crank sample to receiving its wrench, beside a bare relay of the same sample in the same run.
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <vector>

#include "ros/eventually.h"
#include "support/wall_clock.h"

namespace hammer_loads {
namespace {

using test::eventually;
using Clock = std::chrono::steady_clock;

const std::uint32_t kSamples = test::timesCount() ? 4000 : 1000;
constexpr std::chrono::microseconds kPeriod{1000};

struct Latencies {
  std::vector<double> microseconds;
  double at(double part) {
    std::sort(microseconds.begin(), microseconds.end());
    return microseconds.at(static_cast<std::size_t>(part * static_cast<double>(microseconds.size() - 1)));
  }
};

class LatencyTest : public testing::Test {
 protected:
  LatencyTest() {
    const auto hints = ros::TransportHints().tcpNoDelay();
    crank_ = node_.advertise<sensor_msgs::JointState>("crank", kSamples);
    wrench_ = node_.subscribe<geometry_msgs::WrenchStamped>(
        "hammer_loads/hull_wrench", kSamples,
        [this](const geometry_msgs::WrenchStamped::ConstPtr& m) { arrived(m->header.stamp, node_latency_); }, {},
        hints);
    relay_ = node_.subscribe<sensor_msgs::JointState>(
        "relayed", kSamples,
        [this](const sensor_msgs::JointState::ConstPtr& m) { arrived(m->header.stamp, relay_latency_); }, {}, hints);
  }

  void arrived(const ros::Time& stamp, Latencies& latencies) {
    const auto sent = sent_.find(stamp.toNSec());
    if (sent == sent_.end()) return;
    latencies.microseconds.push_back(std::chrono::duration<double, std::micro>(Clock::now() - sent->second).count());
  }

  ros::NodeHandle node_;
  ros::Publisher crank_;
  ros::Subscriber wrench_, relay_;
  std::map<std::uint64_t, Clock::time_point> sent_;
  Latencies node_latency_, relay_latency_;
};

TEST_F(LatencyTest, TheNodeAddsLittleToABareRelay) {
  ASSERT_TRUE(eventually([this] { return crank_.getNumSubscribers() >= 2 && wrench_.getNumPublishers() > 0; }));
  sensor_msgs::JointState sample;
  sample.header.stamp = ros::Time(900.0);
  sample.name = {"hammer_crank_joint"};
  sample.position.resize(1);
  sample.velocity = {4.0};  // a slow crank, which has a wrench beside a blow as well
  crank_.publish(sample);   // the relay advertises at its first message
  ASSERT_TRUE(eventually([this] { return relay_.getNumPublishers() > 0; }));
  Clock::time_point last = Clock::now();
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const Clock::time_point due = last + kPeriod;
    while (Clock::now() < due) {
      const double left = std::chrono::duration<double>(due - Clock::now()).count();
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(std::max(0.0, left)));
    }
    sample.header.stamp = ros::Time(1000.0 + 1e-3 * i);
    sample.position[0] = 4e-3 * i;
    last = sent_[sample.header.stamp.toNSec()] = Clock::now();
    crank_.publish(sample);
    // One after the other: the relay's own queues hold ten messages.
    ASSERT_TRUE(eventually([this, i] {
      return node_latency_.microseconds.size() == i + 1 && relay_latency_.microseconds.size() == i + 1;
    })) << node_latency_.microseconds.size()
        << " wrenches, " << relay_latency_.microseconds.size() << " relayed";
  }
  std::printf("latency at 1 kHz, us, median / 99 %% / 99.9 %%: node %.0f / %.0f / %.0f, relay %.0f / %.0f / %.0f\n",
              node_latency_.at(0.5), node_latency_.at(0.99), node_latency_.at(0.999), relay_latency_.at(0.5),
              relay_latency_.at(0.99), relay_latency_.at(0.999));
  test::expectTimeWithin(node_latency_.at(0.5), 2.0 * relay_latency_.at(0.5) + 1000.0,
                         "[us] median; the millisecond is for a loaded machine");
}

}  // namespace
}  // namespace hammer_loads
