/// The live grapple as its users see it, run as node and as nodelet.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include "grapple/grapples.h"
#include "ros/eventually.h"
#include "ros/grapple_messages.h"

namespace hammer_loads {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using test::eventually;

class GrappleNodeTest : public testing::Test {
 protected:
  template <typename Message>
  ros::Subscriber keep(const std::string& topic, std::vector<Message>& kept) {
    return node_.subscribe<Message>("grapple/" + topic, 10000, [&kept](const auto& m) { kept.push_back(*m); });
  }

  GrappleNodeTest() {
    joints_ = node_.advertise<sensor_msgs::JointState>("joint_states", 10000);
    subscribers_ = {keep("jaw_edge/left", left_), keep("jaw_edge/right", right_),
                    keep("jaw_edge/right_twist", right_twist_), keep("jaw_edge/left_accel", left_accel_),
                    keep("mechanism", mechanism_)};
    diagnostics_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, [this](const auto& m) {
      for (const auto& status : m->status) {
        if (status.name.find("slider") != std::string::npos) slider_status_ = status;
      }
    });
    EXPECT_TRUE(eventually([this] {
      return joints_.getNumSubscribers() > 0 &&
             std::all_of(subscribers_.begin(), subscribers_.end(), [](auto& s) { return s.getNumPublishers() > 0; });
    })) << "the node must be there";
    // Samples of an earlier test count in the node, so stamps begin well after them.
    static double next_start = 1000.0;
    stamp_ = ros::Time(next_start += 1000.0);
  }

  void publish(double slider, std::optional<double> velocity) {
    stamp_ += ros::Duration(0.01);
    joints_.publish(test::sliderMessage(stamp_, slider, velocity));
  }

  ros::NodeHandle node_;
  ros::Publisher joints_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber diagnostics_;
  std::vector<geometry_msgs::PointStamped> left_, right_;
  std::vector<geometry_msgs::TwistStamped> right_twist_;
  std::vector<geometry_msgs::AccelStamped> left_accel_;
  std::vector<sensor_msgs::JointState> mechanism_;
  DiagnosticStatus slider_status_;
  ros::Time stamp_;
};

TEST_F(GrappleNodeTest, GivesTheLibrarysValuesForEverySample) {
  constexpr int kSamples = 300;
  GrappleTracker tracker(test::grappleOf(test::claimsParameters()));
  std::vector<JawMotion> expected;
  const ros::Time start = stamp_;
  for (int i = 0; i < kSamples; ++i) {
    const double phase = 0.05 * i, slider = 0.332 + 0.3 * std::sin(phase), velocity = 1.5 * std::cos(phase);
    publish(slider, velocity);
    ASSERT_EQ(tracker.update({slider, velocity, 0.0}), SliderRefusal::kNone);
    expected.push_back(tracker.right());
  }
  ASSERT_TRUE(eventually([&] {
    return right_.size() >= kSamples && left_.size() >= kSamples && right_twist_.size() >= kSamples &&
           left_accel_.size() >= kSamples && mechanism_.size() >= kSamples;
  })) << right_.size();
  for (std::size_t i = 0; i < kSamples; ++i) {
    const JawMotion right = expected[i], left = leftJaw(right);
    ASSERT_EQ(right_[i].header.frame_id, "grapple");
    ASSERT_EQ(right_[i].header.stamp, start + ros::Duration(0.01 * (static_cast<double>(i) + 1.0)));
    // An earlier test may have left the node at another start pose, so values agree only to rounding.
    ASSERT_NEAR(right_[i].point.x, right.edge.re, 1e-12);
    ASSERT_NEAR(right_[i].point.y, right.edge.im, 1e-12);
    ASSERT_NEAR(left_[i].point.x, left.edge.re, 1e-12);
    ASSERT_NEAR(right_twist_[i].twist.linear.y, right.edge_velocity.im, 1e-10);
    ASSERT_NEAR(right_twist_[i].twist.angular.z, right.turning_speed, 1e-10);
    ASSERT_NEAR(left_accel_[i].accel.linear.x, left.edge_acceleration.re, 1e-8);
    ASSERT_EQ(mechanism_[i].name.size(), 13u);
  }
}

TEST_F(GrappleNodeTest, ReportsASliderThatIsStaleOrWithoutVelocity) {
  publish(0.4, 0.1);
  ASSERT_TRUE(eventually([&] {
    return !right_.empty() && right_.back().header.stamp == stamp_ && left_.size() == right_.size() &&
           !mechanism_.empty() && mechanism_.back().header.stamp == stamp_;
  }));
  EXPECT_TRUE(eventually([&] {
    return slider_status_.level == DiagnosticStatus::ERROR && slider_status_.message.find("stale") == 0;
  })) << slider_status_.message;
  const std::size_t twists = right_twist_.size();
  // Joint states of other joints do not make the slider alive.
  sensor_msgs::JointState foreign = test::sliderMessage(stamp_, 0.4, 0.1);
  foreign.name[1] = "wheel";
  slider_status_ = {};
  EXPECT_TRUE(eventually([&] {
    joints_.publish(foreign);
    return slider_status_.level == DiagnosticStatus::ERROR;
  }));
  EXPECT_TRUE(eventually([&] {
    publish(0.4, std::nullopt);
    return slider_status_.level == DiagnosticStatus::WARN && slider_status_.message.find("no slider velocity") == 0;
  })) << slider_status_.message;
  EXPECT_EQ(right_twist_.size(), twists);
  ASSERT_TRUE(mechanism_.back().velocity.empty());
}

}  // namespace
}  // namespace hammer_loads
