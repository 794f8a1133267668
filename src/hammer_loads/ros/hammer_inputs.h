/// All input topics of the hammer's loads; counterpart of HammerOutputs.
#pragma once

#include <ros/subscriber.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Counter of gaps in header.seq, which each publisher increments. A gap is a loss in a full queue on either side or in
/// a connection. roscpp does not report how many messages its own queue drops.
class MissingMessages {
 public:
  void take(const std::string& publisher, std::uint32_t sequence) {
    if (last_.size() > kMostPublishers) last_.clear();  // publishers that restart under ever new names
    const auto [known, is_new] = last_.try_emplace(publisher, sequence);
    if (!is_new && sequence > known->second) count_ += sequence - known->second - 1;
    known->second = sequence;  // a lower number means that the publisher restarted
  }
  std::uint64_t count() const { return count_; }

 private:
  static constexpr std::size_t kMostPublishers = 100;
  std::map<std::string, std::uint32_t> last_;
  std::uint64_t count_{};
};

template <typename MessageType>
struct Input {
  using Message = MessageType;
  /// record_time: that of the message, passed on to the outputs that it causes.
  using Take = std::function<void(HammerBridge&, const Message&, const ros::Time& record_time)>;

  std::string topic;  ///< topic name in the settings
  Take take;
  bool wanted{true};  ///< the settings use it
  bool latched{};     ///< sent once; every run and every file of a log begins with it

  Message message{};                                ///< memory for a reader of bags
  std::uint64_t count{};                            ///< messages that a reader has taken
  ros::Subscriber subscriber{};                     ///< subscriber of a node
  MissingMessages missing{};                        ///< lost messages, at a node
  std::chrono::steady_clock::time_point arrived{};  ///< arrival of the last message, at a node
};

struct HammerInputs {
  explicit HammerInputs(const Settings& settings);

  Input<sensor_msgs::JointState> joint_states;
  Input<sensor_msgs::Imu> hull_imu;
  std::deque<Input<sensor_msgs::FluidPressure>> pressures;  ///< one per chamber of the boom's cylinders
  Input<geometry_msgs::WrenchStamped> reference;
  Input<tf2_msgs::TFMessage> tf_static, tf;
  Input<sensor_msgs::JointState> crank;

  /// Visits the inputs of sensors. Joint states are first, so that on a common topic the pitch of a message applies to
  /// its own crank sample. The crank is last, so that a player of bags that waits for its subscriber finds all others
  /// subscribed.
  template <typename Visit>
  void forEachSensor(const Visit& visit) {
    visit(joint_states), visit(hull_imu);
    for (auto& pressure : pressures) visit(pressure);
    visit(reference), visit(crank);
  }
  template <typename Visit>
  void forEach(const Visit& visit) {
    visit(tf_static), visit(tf);
    forEachSensor(visit);
  }
};

/// Topics of the pressures below the settings' prefix, with their cylinders and chambers; none for a boom without
/// cylinders.
struct PressureTopic {
  std::string name;
  std::size_t cylinder{};
  Chamber chamber{};
};
std::vector<PressureTopic> pressureTopics(const Settings& settings);

}  // namespace hammer_loads
