/// The bridge between messages: listeners change no value, nothing throws, no memory is allocated.
#include "hammer_loads/ros/hammer_bridge.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <tuple>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/ros/stamp.h"
#include "support/counting_new.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kept = std::map<std::string, std::vector<Bytes>>;

template <typename Message>
Bytes bytesOf(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/// Keeps messages of the topics that `wants` names; it is asked before each message.
template <typename Wants>
void attach(HammerBridge& bridge, const Wants& wants, Kept& kept) {
  bridge.outputs().forEach([&](auto& output) {
    output.attach(
        [&all = kept[output.name()]](const auto& message, const ros::Time&) { all.push_back(bytesOf(message)); },
        [wants, name = output.name()] { return wants(name); });
  });
}

ros::Time timeOfNs(std::int64_t ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(ns));
  return time;
}

struct SentMessages {
  sensor_msgs::JointState crank, joints;
  SentMessages() {
    crank.name = {"hammer_crank_joint"}, crank.position = {0.0};
    joints.name.assign(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
    joints.position.resize(4), joints.velocity.resize(4);
  }
};

/// Plays a session with drop-outs at this rate and calls after(time) after each sample.
template <typename After>
void play(HammerBridge& bridge, double rate, bool speeds, const After& after) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 8.0;
  machine.crank.rate = rate;
  machine.crank.drop_outs = {{4.0, 4.4}, {6.0, 6.1}};
  const simulation::Session session = simulation::recordSession(machine);
  SentMessages m;
  std::size_t joint = 0;
  for (const auto& r : session.crank) {
    for (; joint < session.joints.size() && session.joints[joint].stamp <= r.stamp; ++joint) {
      m.joints.header.stamp = timeOfNs(session.joints[joint].stamp);
      std::copy(session.joints[joint].position.begin(), session.joints[joint].position.end(),
                m.joints.position.begin());
      std::copy(session.joints[joint].velocity.begin(), session.joints[joint].velocity.end(),
                m.joints.velocity.begin());
      bridge.jointStates(m.joints, m.joints.header.stamp);
    }
    m.crank.header.stamp = timeOfNs(r.stamp);
    m.crank.position[0] = r.angle;
    if (speeds) m.crank.velocity = {*r.speed};
    bridge.crank(m.crank, m.crank.header.stamp);
    after(1e-9 * static_cast<double>(r.stamp - machine.start_stamp));
  }
}

const auto kNothing = [](double) {};
const auto kAll = [](const std::string&) { return true; };

TEST(WhoListens, ChangesNoValue) {
  for (const char* output : {"instantaneous", "mean"}) {
    const Settings settings = test::settingsWith(std::string("output: ") + output + "\nboom: compliant\n");
    Kept all, one;
    HammerBridge with_all(settings), with_one(settings);
    attach(with_all, kAll, all);
    attach(
        with_one, [](const std::string& name) { return name == "hull_wrench"; }, one);
    play(with_all, 50.0, false, kNothing);
    play(with_one, 50.0, false, kNothing);
    ASSERT_GT(all["hull_wrench"].size(), 200U);
    EXPECT_EQ(one["hull_wrench"], all["hull_wrench"]) << output;
  }
}

TEST(WhoListens, GetsWhatTheOthersGotAfterComingBack) {
  const Settings settings = test::settingsWith("boom: compliant\n");
  Kept all, some;
  HammerBridge with_all(settings), with_some(settings);
  attach(with_all, kAll, all);
  play(with_all, 1000.0, true, kNothing);
  bool listens = false;
  attach(
      with_some, [&](const std::string&) { return listens; }, some);
  play(with_some, 1000.0, true, [&](double time) { listens = time < 3.0 || time > 5.0; });  // absent for 10 revolutions
  for (const char* topic : {"pulse", "blow", "joint_loads", "hull_loads"}) {
    ASSERT_GT(some[topic].size(), 5U) << topic;
    ASSERT_LT(some[topic].size(), all[topic].size()) << topic;
    const std::size_t kept = 3;  // at the end, after it returned
    EXPECT_TRUE(std::equal(some[topic].end() - kept, some[topic].end(), all[topic].end() - kept)) << topic;
  }
}

TEST(WhoListens, WantsTheTurnsAloneGetsTheSameAndNoSampleIsComputed) {
  const Settings settings =
      test::settingsWith("boom: compliant\nboom_wrench_links: [arm_link]\nlimit_peak_force_warn_N: 1.0\n");
  Kept all, turns;
  HammerBridge with_all(settings), with_turns(settings);
  attach(with_all, kAll, all);
  with_turns.outputs().forEach([&](auto& output) {
    output.attach(
        [&kept = turns[output.name()]](const auto& message, const ros::Time&) { kept.push_back(bytesOf(message)); },
        [from = output.loggedFrom()] { return from <= LoggedOutputs::kPerTurn; });
  });
  for (HammerBridge* bridge : {&with_all, &with_turns}) {
    play(*bridge, 1000.0, true, kNothing);
    bridge->finishRun();
  }
  std::size_t once_a_turn = 0;
  with_turns.outputs().forEach([&](auto& output) {
    EXPECT_EQ(all[output.name()].size(), output.sent()) << output.name();
    if (output.loggedFrom() <= LoggedOutputs::kPerTurn) {
      ++once_a_turn;
      EXPECT_EQ(turns[output.name()], all[output.name()]) << output.name();
    } else {
      EXPECT_TRUE(turns[output.name()].empty()) << output.name();
      EXPECT_TRUE(output.message.header.stamp.isZero()) << output.name();
    }
  });
  EXPECT_EQ(once_a_turn, 6U);
}

constexpr int kImu = 1, kCrank = 100;  // topics; the crank is last

/// Message of a sensor: stamp, topic (by which bursts are ordered) and the call that passes it to a bridge.
struct Arrival {
  std::int64_t stamp;
  int topic;
  std::function<void(HammerBridge&)> give;
};

/// Returns all messages of a session on a boom, topic by topic.
std::vector<Arrival> messagesOf(const simulation::Session& session) {
  std::vector<Arrival> messages;
  for (const simulation::JointReading& r : session.joints) {
    sensor_msgs::JointState m = SentMessages().joints;
    m.header.stamp = timeOfNs(r.stamp);
    m.position.assign(r.position.begin(), r.position.end()), m.velocity.assign(r.velocity.begin(), r.velocity.end());
    messages.push_back({r.stamp, 0, [m](HammerBridge& bridge) { bridge.jointStates(m, m.header.stamp); }});
  }
  for (const simulation::HullImuReading& r : session.imu) {
    sensor_msgs::Imu m;
    m.header.stamp = timeOfNs(r.stamp);
    m.linear_acceleration.x = r.specific_force[0], m.linear_acceleration.z = r.specific_force[2];
    m.angular_velocity.y = r.rate[1];
    messages.push_back({r.stamp, kImu, [m](HammerBridge& bridge) { bridge.hullImu(m, m.header.stamp); }});
  }
  for (const simulation::PressureReading& r : session.pressures) {
    for (std::size_t i = 0; i < r.bore.size(); ++i) {
      for (const auto& [chamber, pressure] :
           {std::pair{Chamber::kBore, r.bore[i]}, std::pair{Chamber::kRod, r.rod[i]}}) {
        sensor_msgs::FluidPressure m;
        m.header.stamp = timeOfNs(r.stamp);
        m.fluid_pressure = pressure;
        const auto give = [m, i, chamber = chamber](HammerBridge& bridge) {
          bridge.cylinderPressure(i, chamber, m, m.header.stamp);
        };
        messages.push_back({r.stamp, 2 + 2 * static_cast<int>(i) + static_cast<int>(chamber), give});
      }
    }
  }
  for (const simulation::CrankReading& r : session.crank) {
    sensor_msgs::JointState m = SentMessages().crank;
    m.header.stamp = timeOfNs(r.stamp);
    m.position = {r.angle}, m.velocity = {*r.speed};
    messages.push_back({r.stamp, kCrank, [m](HammerBridge& bridge) { bridge.crank(m, m.header.stamp); }});
  }
  return messages;
}

/// A machine on its boom with IMU and pressures; its messages reach a bridge in any order.
class MessagesOnBoom : public ::testing::Test {
 protected:
  struct Played {
    std::array<accuracy::SignalError, 3> torque;  ///< of the cylinders' joints without weight, against the truth
    std::vector<std::string> warnings;

    double worst() const { return std::max({torque[0].rms(), torque[1].rms(), torque[2].rms()}); }
  };

  explicit MessagesOnBoom(const simulation::RockSettings& rock = {}) {
    machine_.on_boom.rock = rock;
    machine_.duration = 6.0;
    machine_.crank.rate = 500.0;
    machine_.hammer.drive_reaction_ratio = 1.0;
    machine_.on_boom.on = true;
    machine_.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
    machine_.on_boom.pressures = {250.0, 2e4, 6e6};
    session_ = simulation::recordSession(machine_);
    for (std::size_t i = 0; i < session_.crank.size(); ++i) truth_[session_.crank[i].stamp] = &session_.on_boom[i];
    messages_ = messagesOf(session_);
    sort([](const Arrival& m) { return std::tuple{m.stamp, m.topic}; });
  }
  template <typename Key>
  void sort(const Key& key) {
    std::stable_sort(messages_.begin(), messages_.end(),
                     [&key](const Arrival& a, const Arrival& b) { return key(a) < key(b); });
  }

  /// Plays the messages in the order of a key.
  template <typename Key>
  Played play(const Key& key) {
    sort(key);
    Played played;
    HammerBridge bridge(test::settingsWith("boom: compliant\nhull_motion: imu\nboom_stiffness: identified\n"));
    bridge.outputs().joint_loads.attach([&](const JointLoads& m, const ros::Time&) {
      const auto at = truth_.find(stampOf(m.header.stamp));
      if (at == truth_.end() || at->first < machine_.start_stamp + 3'000'000'000) return;
      for (std::size_t i = 0; i < 3; ++i) {
        const double weight = m.joint[i + 1].weight_torque;
        played.torque[i].add(m.joint[i + 1].total_torque - weight, -at->second->hold[static_cast<int>(i)] - weight);
      }
    });
    for (const Arrival& message : messages_) message.give(bridge);
    for (const Warning& warning : warningsOf(bridge.pipeline())) played.warnings.push_back(warning.text);
    EXPECT_GT(played.torque[0].count, 1300);
    return played;
  }
  Played playInOrder() {
    return play([](const Arrival& m) { return std::tuple{m.stamp, m.topic}; });
  }

  std::vector<Arrival> messages_;

 private:
  simulation::MachineSettings machine_ = simulation::workingMo100();
  simulation::Session session_;
  std::map<std::int64_t, const simulation::OnBoomTruth*> truth_;
};

/// A node that was blocked receives the messages of that time topic by topic.
TEST_F(MessagesOnBoom, GiveTheSameTorquesInBurstsAsInOrder) {
  const Played in_order = playInOrder();
  for (const std::int64_t held_up : {40'000'000, 300'000'000}) {  // [ns]
    const Played in_bursts = play([held_up](const Arrival& m) {
      return std::tuple{m.stamp / held_up, m.topic, m.stamp};
    });
    EXPECT_EQ(in_bursts.warnings, in_order.warnings);
    std::printf("torque %.2f %% rms, in bursts %.2f %%\n", 100.0 * in_order.worst(), 100.0 * in_bursts.worst());
    EXPECT_LT(in_bursts.worst(), 1.1 * in_order.worst());
  }
}

/// A bus delays a topic, but the stamps are those of the measurement.
TEST_F(MessagesOnBoom, CostLittleWhereOneTopicIsLate) {
  const Played in_order = playInOrder();
  const auto lateBy = [&](int topic, std::int64_t late) {
    const Played played = play([=](const Arrival& m) {
      return std::tuple{m.stamp + (m.topic == topic ? late : 0), m.topic};
    });
    std::printf("topic %d %.0f ms late: torque %.2f %% rms\n", topic, 1e-6 * static_cast<double>(late),
                100.0 * played.worst());
    return played;
  };
  const Played crank = lateBy(kCrank, 100'000'000);
  EXPECT_LT(crank.worst(), 1.1 * in_order.worst());
  EXPECT_EQ(crank.warnings, in_order.warnings);
  for (const std::int64_t late : {4'000'000, 18'000'000, 40'000'000}) EXPECT_LT(lateBy(kImu, late).worst(), 0.03);
}

struct MessagesOnRock : MessagesOnBoom {
  MessagesOnRock() : MessagesOnBoom({3e7, 3.0, 4000.0}) {}
};

/// The IMU alone does not measure the rock's force.
TEST_F(MessagesOnRock, HaveNoJointLoadsWithoutPressures) {
  HammerBridge bridge(test::settingsWith("boom: compliant\nhull_motion: imu\nboom_stiffness: identified\n"));
  ros::Time loads, wrench;
  bridge.outputs().joint_loads.attach([&](const JointLoads& m, const ros::Time&) { loads = m.header.stamp; });
  bridge.outputs().hull_wrench.attach(
      [&](const geometry_msgs::WrenchStamped& m, const ros::Time&) { wrench = m.header.stamp; });
  for (const Arrival& message : messages_)
    if (message.topic <= kImu || message.topic == kCrank) message.give(bridge);
  EXPECT_GT(wrench, loads + ros::Duration(0.5));
}

/// Readings do not wait for stamps of a clock that is an hour ahead or for a crank that has stopped.
TEST(ReadingQueue, HoldsReadingsForOneSecondAtMost) {
  std::vector<int> passed;
  ReadingQueue<int> queue([&passed](StampNs, int reading) { passed.push_back(reading); });
  const StampNs second = 1'000'000'000, crank = 10 * second;
  queue.add(crank, 0, crank);
  for (int i = 1; i <= 5; ++i) queue.add(crank + i * second / 5, i, crank);
  EXPECT_EQ(passed, std::vector<int>{0});
  queue.add(crank + 6 * second / 5, 6, crank);
  EXPECT_EQ(passed, (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
  queue.add(crank + 3600 * second, 7, crank);
  EXPECT_EQ(passed.back(), 7);
}

/// Records the pieces that it receives.
class Notes final : public life::PieceSink {
 public:
  void begin(const life::LedgerMachine&, const life::RunId&) override {}
  void refuse(const std::string&) override {}
  void add(const life::LifePiece& piece) override { pieces.push_back(piece); }
  void end(const life::LifePiece& last) override {
    pieces.push_back(last);
    ++ended;
  }
  std::vector<life::LifePiece> pieces;
  std::size_t ended{};
};

TEST(LoadCycles, ComeEachPeriodOfStampsAndAtTheEnd) {
  Notes notes;
  HammerBridge bridge(test::settingsWith("life_period_s: 2.0\n"), &notes);
  std::vector<LoadCycles> counts;
  bridge.outputs().load_cycles.attach([&](const LoadCycles& count, const ros::Time&) { counts.push_back(count); });
  play(bridge, 1000.0, true, kNothing);
  EXPECT_EQ(counts.size(), 3U) << "of 8 s, the last period is not over";
  bridge.finishRun();
  bridge.finishRun();
  ASSERT_EQ(counts.size(), 4U);
  ASSERT_EQ(notes.pieces.size(), 4U);
  EXPECT_EQ(notes.ended, 1U);
  std::uint64_t samples = 0, turns = 0;
  for (const life::LifePiece& piece : notes.pieces) {
    samples += piece.counts[1].tally.counted;
    turns += piece.turns;
  }
  EXPECT_EQ(counts.back().channel[1].samples, samples);
  EXPECT_EQ(counts.back().turns, turns);
  EXPECT_EQ(counts.back().turns, bridge.outputs().blow.sent());
  EXPECT_GT(counts.back().turns, counts[1].turns);
  EXPECT_EQ(counts.back().channel[1].gaps, 1U) << "0.4 s; over 0.1 s the model knows the way";
  EXPECT_EQ(counts.back().since, counts[0].since);
}

TEST(LoadCycles, NameTheirKeyBeyondTheFullScale) {
  HammerBridge bridge(test::settingsWith("hull_z_full_scale_greatest: 3000.0\n"));
  play(bridge, 1000.0, true, kNothing);
  const std::vector<Warning> warnings = bridge.life().warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].text.find("hull_wrench/force_z ("), std::string::npos) << warnings[0].text;
  EXPECT_NE(warnings[0].text.find("hull_z_full_scale_greatest"), std::string::npos) << warnings[0].text;
  EXPECT_EQ(warnings[0].text.find("least"), std::string::npos) << warnings[0].text;
}

TEST(Stamps, AreCountedBeyondEveryClockAndTheNextGoodOneWorks) {
  HammerBridge bridge(test::settingsWith("boom: auto\n"));
  SentMessages m;
  m.crank.velocity = {0.0};
  const auto send = [&](std::uint32_t sec, std::uint32_t nsec) {
    m.crank.header.stamp.sec = sec, m.crank.header.stamp.nsec = nsec;
    m.joints.header.stamp = m.crank.header.stamp;
    bridge.jointStates(m.joints, ros::Time(1.0));
    bridge.crank(m.crank, ros::Time(1.0));
  };
  EXPECT_NO_THROW(send(4294967295U, 4294967295U));
  EXPECT_EQ(bridge.pipeline().counts().refusedFor(Refusal::kBadStamp), 1U);
  EXPECT_NO_THROW(send(4294967295U, 999999999U));
  EXPECT_NO_THROW(send(1, 0));
  EXPECT_NO_THROW(send(1, 1000000));
  EXPECT_NO_THROW(send(1, 2000000));
  EXPECT_GT(bridge.pipeline().counts().accepted, 0U);
}

TEST(HotPath, AllocatesNothingPerMessage) {
  HammerBridge bridge(test::settingsWith("boom: compliant\nboom_wrench_links: [arm_link]\n"));
  std::size_t sent = 0;
  bridge.outputs().forEach([&](auto& output) { output.attach([&](const auto&, const ros::Time&) { ++sent; }); });
  SentMessages m;
  m.crank.velocity = {0.0};
  double angle = 0.5;
  const auto send = [&](int i) {
    m.joints.header.stamp = m.crank.header.stamp =
        ros::Time(1000 + i / 1000, static_cast<std::uint32_t>(i % 1000) * 1000000U);
    m.crank.position[0] = angle += 0.02, m.crank.velocity[0] = 20.0;
    if (i % 10 == 0) bridge.jointStates(m.joints, m.joints.header.stamp);
    bridge.crank(m.crank, m.crank.header.stamp);
  };
  for (int i = 0; i < 1000; ++i) send(i);
  const std::size_t before = test::allocations, sent_before = sent;
  ASSERT_GT(before, 0U) << "the counter works";
  for (int i = 1000; i < 3000; ++i) send(i);
  EXPECT_EQ(test::allocations, before);
  EXPECT_GT(sent, sent_before + 2000U * 5U);
}

}  // namespace
}  // namespace hammer_loads
