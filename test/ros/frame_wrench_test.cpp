#include "hammer_loads/ros/frame_wrench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hammer_loads {
namespace {

constexpr char kHull[] = "hammer_hull";

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child, double time, double x,
                                          double z, double pitch = 0.0) {
  geometry_msgs::TransformStamped t;
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.header.stamp = ros::Time(time);
  t.transform.translation.x = x;
  t.transform.translation.z = z;
  t.transform.rotation.y = std::sin(0.5 * pitch);
  t.transform.rotation.w = std::cos(0.5 * pitch);
  return t;
}

struct Told {
  std::size_t frame{};
  ros::Time stamp;
  Wrench load;
  double record_time{};
};

class Frames : public testing::Test {
 protected:
  void tf(const std::vector<geometry_msgs::TransformStamped>& transforms, double now, bool is_static = false) {
    tf2_msgs::TFMessage message;
    message.transforms = transforms;
    frames_.transforms(message, is_static, ros::Time(now));
  }
  /// Passes on a load along z with stamp and record time.
  void load(double stamp, double now, double force = 20e3) {
    frames_.wrench(ros::Time(stamp), {0.0, force, 7.0}, ros::Time(now));
  }
  std::vector<Told> told_;
  FrameWrenches frames_{{"gauge", "other"},
                        kHull,
                        0.5,
                        [this](std::size_t frame, const ros::Time& stamp, const Wrench& wrench, const ros::Time& now) {
                          told_.push_back({frame, stamp, wrench, now.toSec()});
                        }};
};

TEST_F(Frames, IncludeTheLeverArm) {
  tf({transform("gauge", kHull, 0.0, 2.5, 0.0)}, 1.0, true);
  load(1.0, 1.1);
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(told_[0].frame, 0U);
  EXPECT_EQ(told_[0].stamp, ros::Time(1.0));
  EXPECT_EQ(told_[0].record_time, 1.1);
  EXPECT_EQ(told_[0].load.force.z(), 20e3);
  EXPECT_EQ(told_[0].load.torque.y(), 7.0 - 50e3);
  EXPECT_EQ(frames_.counts(0).published, 1U);
  EXPECT_EQ(frames_.complaint(0), "");
}

TEST_F(Frames, FollowAMovingTreeAtTheStamp) {
  // arm carries the hull on one side and on the other the gauge, rotated by 90 deg about y.
  tf({transform("arm", "gauge", 0.0, -0.5, 0.2, 0.5 * std::acos(-1.0))}, 1.0, true);
  tf({transform("arm", kHull, 1.0, 1.0, 0.0)}, 1.0);
  tf({transform("arm", kHull, 2.0, 2.0, 0.4)}, 2.0);
  load(1.25, 2.0);
  ASSERT_EQ(told_.size(), 1U);
  // From the gauge to the hull (1.25 + 0.5, -0.1) in the arm's axes; gauge x is -z of the arm, gauge z is its x.
  const Wrench& w = told_[0].load;
  EXPECT_NEAR(w.force.x(), -20e3, 1e-9);
  EXPECT_NEAR(w.force.z(), 0.0, 1e-9);
  EXPECT_NEAR(w.torque.y(), 7.0 - 1.75 * 20e3, 1e-8);
}

TEST_F(Frames, AWrenchWaitsForItsTransformAndIsRecordedWithIt) {
  tf({transform("gauge", kHull, 1.000, 0.0, 0.0)}, 1.000);
  for (int i = 1; i <= 20; ++i) load(1.0 + 1e-3 * i, 1.0 + 1e-3 * i, i);
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(frames_.counts(0).waiting, 20U);
  tf({transform("gauge", kHull, 1.0105, 0.0, 0.0)}, 1.0205);
  ASSERT_EQ(told_.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(told_[i].load.force.z(), static_cast<double>(i + 1));
    EXPECT_EQ(told_[i].record_time, 1.0205);
  }
  tf({transform("gauge", kHull, 1.040, 0.0, 0.0)}, 1.041);
  EXPECT_EQ(told_.size(), 20U);
  EXPECT_EQ(frames_.counts(0).waiting, 0U);
  EXPECT_EQ(frames_.counts(0).dropped, 0U);
}

TEST_F(Frames, PublishNothingAndNameTheFrameWithoutATransform) {
  tf({transform("gauge", kHull, 0.0, 1.0, 0.0)}, 0.9, true);
  load(1.0, 1.0);
  EXPECT_EQ(told_.size(), 1U);  // no output for the other frame
  EXPECT_EQ(frames_.counts(1).waiting, 1U);
  EXPECT_EQ(frames_.complaint(1), "");
  load(1.5, 1.5);
  EXPECT_EQ(frames_.counts(1).dropped, 0U);
  load(1.6, 1.6);
  EXPECT_EQ(told_.size(), 3U);
  EXPECT_EQ(frames_.counts(1).dropped, 1U);
  EXPECT_EQ(frames_.counts(1).waiting, 2U);
  const std::string complaint = frames_.complaint(1);
  EXPECT_EQ(complaint.rfind("other: no transform from hammer_hull within 0.5 s: ", 0), 0U) << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
  EXPECT_EQ(frames_.complaint(0), "");
  // The transform is available again.
  tf({transform(kHull, "other", 0.0, 1.0, 0.0)}, 1.7, true);
  EXPECT_EQ(frames_.counts(1).published, 2U);
  EXPECT_EQ(frames_.complaint(1), "");
}

TEST_F(Frames, DoNotWaitForWrenchesOlderThanTf) {
  load(1.0, 1.0);
  load(1.2, 1.2);
  tf({transform("gauge", kHull, 1.1, 0.0, 0.0)}, 1.21);
  EXPECT_EQ(frames_.counts(0).dropped, 1U);
  EXPECT_EQ(frames_.counts(0).waiting, 1U);
  tf({transform("gauge", kHull, 1.21, 0.0, 0.0)}, 1.22);
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(told_[0].stamp, ros::Time(1.2));
}

TEST_F(Frames, AQueueIsBounded) {
  for (int i = 0; i < 5000; ++i) load(1.0 + 1e-5 * i, 1.0 + 1e-5 * i, i);
  EXPECT_EQ(frames_.counts(0).waiting, 4096U);
  EXPECT_EQ(frames_.counts(0).dropped, 904U);
  tf({transform("gauge", kHull, 0.0, 0.0, 0.0)}, 1.06, true);
  ASSERT_EQ(told_.size(), 4096U);
  EXPECT_EQ(told_.front().load.force.z(), 904.0);
  EXPECT_EQ(told_.back().load.force.z(), 4999.0);
}

TEST_F(Frames, AcceptTimeThatRestarts) {
  tf({transform("gauge", "mount", 0.0, 1.0, 0.0)}, 5.0, true);
  tf({transform("mount", kHull, 5.0, 0.0, 0.0)}, 5.0);
  load(5.1, 5.1);
  frames_.reset();
  EXPECT_EQ(frames_.counts(0).waiting, 0U);
  load(1.05, 1.05);
  tf({transform("mount", kHull, 1.0, 0.0, 0.0)}, 1.05);
  EXPECT_TRUE(told_.empty());
  tf({transform("mount", kHull, 1.1, 0.0, 0.0)}, 1.1);
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(told_[0].load.torque.y(), 7.0 - 20e3);
}

/// tf2 throws in the callback for a stamp near the end of time. Transforms that it accepts may still be invalid.
TEST_F(Frames, RefuseStampsBeyondTf2AndUseTheNextGoodOne) {
  const double nan = std::nan("");
  std::vector<geometry_msgs::TransformStamped> bad(8, transform("gauge", kHull, 1.0, 2.5, 0.0));
  bad[0].header.stamp = ros::Time(4294967295U, 999999999U);
  bad[1].header.stamp = ros::Time(4294967290U, 0);
  bad[2].transform.translation.x = 1e308;
  bad[3].transform.translation.y = nan;
  bad[4].transform.rotation.w = nan;
  bad[5].transform.rotation.w = 0.0;
  bad[6].child_frame_id.clear();
  bad[7].transform.rotation.w = 1e200;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    for (const bool is_static : {false, true}) ASSERT_NO_THROW(tf({bad[i]}, 1.0, is_static)) << i;
    load(1.0, 1.1);
    EXPECT_TRUE(told_.empty()) << i;
  }
  tf({transform("gauge", kHull, 0.0, 2.5, 0.0)}, 1.2, true);
  load(1.2, 1.2);
  ASSERT_FALSE(told_.empty());
  EXPECT_NEAR(told_.back().load.torque.y(), 7.0 - 2.5 * 20e3, 1e-6);
}

TEST_F(Frames, AnyTransformAtAnyTimeGivesFiniteWrenchesOrNone) {
  std::mt19937_64 random(3);
  const auto number = [&] {
    constexpr double kOdd[] = {0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, 1e9, std::numeric_limits<double>::infinity()};
    const auto pick = random() % 12;
    return pick < 8 ? kOdd[pick] : std::uniform_real_distribution<>(-2.0, 2.0)(random);
  };
  const auto time = [&] {
    constexpr std::uint32_t kOdd[] = {0, 1, 10, 1700000000U, 2147483647U, 4294963000U, 4294967294U, 4294967295U};
    return ros::Time(kOdd[random() % 8], static_cast<std::uint32_t>(random() % 1000000000));
  };
  const char* names[] = {"gauge", kHull, "other", "", "/gauge", "a b"};
  for (int i = 0; i < 20000; ++i) {
    auto t = transform(names[random() % 6], names[random() % 6], 0.0, number(), number(), number());
    t.header.stamp = time();
    tf2_msgs::TFMessage message;
    message.transforms = {t};
    ASSERT_NO_THROW(frames_.transforms(message, random() % 8 == 0, time())) << i;
    ASSERT_NO_THROW(frames_.wrench(time(), {0.0, 20e3, 0.0}, time())) << i;
    if (i % 100 == 99) frames_.reset();
  }
  EXPECT_FALSE(told_.empty()) << "some chains are good";
  for (const Told& told : told_)
    ASSERT_TRUE(std::isfinite(told.load.force.z() + told.load.torque.x() + told.load.torque.y()));
}

}  // namespace
}  // namespace hammer_loads
