/// The live node in simulated time that stops, jumps and runs backwards. The node runs in this process, so that the
/// time of each arrival is given exactly.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <map>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/ros/live_node.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/stamp.h"
#include "ros/eventually.h"
#include "support/known_zero.h"

namespace hammer_loads {
namespace {

using test::eventually;

constexpr double kTurn = 0.2;                       // [s]
constexpr std::int64_t kStart = 1'000'000'000'000;  // [ns]

using sensor_msgs::JointState;
using Inputs = std::vector<JointState>;  // of both topics in order of arrival; a crank message has one joint

bool isCrank(const JointState& message) { return message.name.size() == 1; }

StampNs stampOf(const std_msgs::Header& header) { return static_cast<StampNs>(header.stamp.toNSec()); }

JointState message(StampNs stamp, std::vector<std::string> names, std::vector<double> positions) {
  JointState m;
  m.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  m.name = std::move(names);
  m.position = std::move(positions);
  return m;
}

/// Returns a working machine's first second, with joint states among the crank samples.
Inputs recordInputs() {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 1.0;
  machine.start_stamp = kStart;
  const simulation::Session session = simulation::recordSession(machine);
  Inputs inputs;
  for (const auto& joints : session.joints)
    inputs.push_back(message(joints.stamp, {simulation::kBoomJoints.begin(), simulation::kBoomJoints.end()},
                             {joints.position.begin(), joints.position.end()}));
  for (const auto& crank : session.crank) {
    inputs.push_back(message(crank.stamp, {"hammer_crank_joint"}, {crank.angle}));
    inputs.back().velocity = {*crank.speed};
  }
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const JointState& a, const JointState& b) { return a.header.stamp < b.header.stamp; });
  return inputs;
}

/// Returns the inputs from an instant on [s], with all stamps delayed by `later` [s].
Inputs from(double begin, const Inputs& inputs, double later = 0.0) {
  Inputs part;
  for (const JointState& input : inputs) {
    if (stampOf(input.header) < kStart + static_cast<StampNs>(1e9 * begin)) continue;
    part.push_back(input);
    part.back().header.stamp += ros::Duration(later);
  }
  return part;
}

/// Sets the zero as known, as in the node: no sample is withheld for it.
Settings withKnownZero(Settings settings) {
  settings.pipeline.crank_zero_std = kKnownZeroStd;
  return settings;
}

class SimulatedTime : public testing::Test {
 protected:
  SimulatedTime() {
    ros::Time::setNow(ros::Time());  // no /clock yet
    std::vector<std::string> problems;
    node_ = makeHammerNode(handle_, ros::NodeHandle("~"), problems);
    EXPECT_TRUE(problems.empty());
    // Subscribed after the node: a message that has arrived here has been processed there.
    const auto count = [this](const JointState::ConstPtr&) { ++arrived_; };
    crank_arrival_ = handle_.subscribe<JointState>("crank", 10000, count);
    joint_arrival_ = handle_.subscribe<JointState>("joint_states", 10000, count);
    wrench_ = handle_.subscribe<geometry_msgs::WrenchStamped>(
        ros::this_node::getName() + "/hull_wrench", 10000,
        [this](const geometry_msgs::WrenchStamped::ConstPtr& m) { wrenches_.push_back(*m); });
    diagnostics_ = handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& m) {
          for (const auto& status : m->status)
            for (const auto& value : status.values) values_[value.key] = value.value;
        });
    crank_ = handle_.advertise<JointState>("crank", 10000);
    joints_ = handle_.advertise<JointState>("joint_states", 10000);
    EXPECT_TRUE(eventually([this] {
      return crank_.getNumSubscribers() > 0 && joints_.getNumSubscribers() > 0 && wrench_.getNumPublishers() > 0 &&
             diagnostics_.getNumPublishers() > 0;
    }));
  }

  void send(const JointState& input) {
    const std::size_t before = arrived_;
    (isCrank(input) ? crank_ : joints_).publish(input);
    ASSERT_TRUE(eventually([&] { return arrived_ > before; }));
  }

  /// Sends each input when the clock shows its stamp.
  void play(const Inputs& inputs) {
    for (const JointState& input : inputs) {
      ros::Time::setNow(input.header.stamp);
      send(input);
    }
  }

  /// Returns the wrenches since the last call. The last one expected has this stamp.
  std::vector<geometry_msgs::WrenchStamped> takeWrenches(const ros::Time& last) {
    EXPECT_TRUE(eventually([&] { return !wrenches_.empty() && wrenches_.back().header.stamp == last; }));
    std::vector<geometry_msgs::WrenchStamped> taken;
    taken.swap(wrenches_);
    return taken;
  }

  /// Compares the wrenches with those of a pipeline that has received only these inputs.
  void expectWrenchesOf(const Inputs& inputs) {
    const auto told = takeWrenches(inputs.back().header.stamp);
    Pipeline pipeline(settings_.mechanism, settings_.pipeline);
    std::size_t n = 0;
    for (const JointState& input : inputs) {
      const StampNs stamp = stampOf(input.header);
      if (!isCrank(input)) pipeline.boomJoints(stamp, input.name, input.position, input.velocity);
      if (!isCrank(input)) continue;
      const SampleResult& loads = pipeline.crankJoint(stamp, input.name, input.position, input.velocity);
      if (loads.refusal) continue;
      ASSERT_LT(n, told.size());
      const geometry_msgs::WrenchStamped& wrench = told[n++];
      ASSERT_EQ(stampOf(wrench.header), stamp) << n;
      ASSERT_EQ(wrench.wrench.force.x, loads.wrench.force_x) << n;
      ASSERT_EQ(wrench.wrench.force.z, loads.wrench.force_z) << n;
      ASSERT_EQ(wrench.wrench.torque.y, loads.wrench.torque_y) << n;
    }
    EXPECT_EQ(n, told.size());
    EXPECT_GT(n, inputs.size() * 9 / 10) << "hardly any is refused";
  }

  void expectDiagnostic(const std::string& key, const std::string& value) {
    EXPECT_TRUE(eventually([&] { return values_[key] == value; })) << key << ' ' << values_[key];
  }

  const Settings settings_ = withKnownZero(*loadFiles(configDirectory(), {}).value);
  const Inputs inputs_ = recordInputs();
  ros::NodeHandle handle_;
  std::unique_ptr<LiveNode> node_;
  ros::Publisher crank_, joints_;
  ros::Subscriber crank_arrival_, joint_arrival_, wrench_, diagnostics_;
  std::size_t arrived_{};
  std::vector<geometry_msgs::WrenchStamped> wrenches_;
  std::map<std::string, std::string> values_;
};

TEST_F(SimulatedTime, EachLoopRestartsAndGivesTheSame) {
  for (const double begin : {0.0, 0.0, 0.4, 0.0}) {
    SCOPED_TRACE(begin);
    const Inputs loop = from(begin, inputs_);
    play(loop);
    expectWrenchesOf(loop);
  }
  expectDiagnostic("restarts", "4");
}

TEST_F(SimulatedTime, NeedsHeaderStampsAloneBeforeTheFirstClock) {
  const std::size_t half = inputs_.size() / 2;
  for (std::size_t i = 0; i < half; ++i) send(inputs_[i]);
  play({inputs_.begin() + static_cast<std::ptrdiff_t>(half), inputs_.end()});
  expectWrenchesOf(inputs_);
  expectDiagnostic("restarts", "1");  // the restart of the clock is not one of the machine
}

TEST_F(SimulatedTime, DetectsALoopByItsStampsWithoutAClock) {
  for (const JointState& input : inputs_) send(input);
  takeWrenches(inputs_.back().header.stamp);
  for (const JointState& input : inputs_) send(input);
  const auto again = takeWrenches(inputs_.back().header.stamp);
  EXPECT_LT(stampOf(again.front().header), kStart + static_cast<StampNs>(1e9 * kTurn));
  for (std::size_t i = 1; i < again.size(); ++i) ASSERT_GT(again[i].header.stamp, again[i - 1].header.stamp);
  expectDiagnostic("restarts", "2");
}

TEST_F(SimulatedTime, SamplesOfTheNextLoopMayOvertakeTheClock) {
  constexpr std::ptrdiff_t kAhead = 20;
  play(inputs_);
  takeWrenches(inputs_.back().header.stamp);
  for (std::ptrdiff_t i = 0; i < kAhead; ++i) send(inputs_[static_cast<std::size_t>(i)]);  // the old clock stands still
  const Inputs rest(inputs_.begin() + kAhead, inputs_.end());
  play(rest);
  const ros::Time last = rest.back().header.stamp;
  ASSERT_TRUE(eventually([&] { return !wrenches_.empty() && wrenches_.back().header.stamp == last; }));
  for (std::size_t i = 1; i < wrenches_.size(); ++i)
    ASSERT_GT(wrenches_[i].header.stamp, wrenches_[i - 1].header.stamp);
  EXPECT_LT(stampOf(wrenches_.front().header), kStart + static_cast<StampNs>(1e9 * kTurn));
  wrenches_.erase(wrenches_.begin(), std::find_if(wrenches_.begin(), wrenches_.end(), [&](const auto& wrench) {
                    return wrench.header.stamp >= rest.front().header.stamp;
                  }));
  expectWrenchesOf(rest);
}

TEST_F(SimulatedTime, RestartsFarForwardAndRefusesALateStamp) {
  play(inputs_);
  takeWrenches(inputs_.back().header.stamp);
  const Inputs later = from(0.0, inputs_, 1e6);
  const auto middle = later.begin() + static_cast<std::ptrdiff_t>(later.size() / 2);
  play({later.begin(), middle});
  const auto last = std::find_if(std::make_reverse_iterator(middle), later.rend(), isCrank);
  const auto first = takeWrenches(last->header.stamp);
  EXPECT_LT(first.front().header.stamp - later.front().header.stamp, ros::Duration(kTurn));
  send(*std::find_if(inputs_.begin(), inputs_.end(), isCrank));  // a million seconds late
  play({middle, later.end()});
  const auto rest = takeWrenches(later.back().header.stamp);
  EXPECT_EQ(rest.size(), static_cast<std::size_t>(std::count_if(middle, later.end(), isCrank))) << "nothing of it";
  expectDiagnostic("refused: out of order", "1");
  expectDiagnostic("restarts", "2");
}

}  // namespace
}  // namespace hammer_loads
