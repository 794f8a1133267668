/// Output topic whose message is filled in place and sent to all attached receivers. Also the destinations of a table
/// of outputs, which are a node's topics and its log, or a bag.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/bag_writer.h"
#include "hammer_loads/log/log_settings.h"

namespace hammer_loads {

enum class Delivery {
  kEach,
  kOnRequest,  ///< left out of every log, and of bags unless requested
  kLast,       ///< late subscribers get the last message
  kLatched,    ///< one message per run, repeated for late subscribers and in every file
};

template <typename MessageType>
class Output {
 public:
  using Message = MessageType;
  /// record_time: that of the input that caused the message.
  using Deliver = std::function<void(const Message&, const ros::Time& record_time)>;
  using Wants = std::function<bool()>;

  /// name: relative to the node's private namespace or to the prefix of a bag's outputs. logged_from: lowest value of
  /// log_outputs that logs it.
  explicit Output(std::string name, LoggedOutputs logged_from = LoggedOutputs::kAll,
                  Delivery delivery = Delivery::kEach)
      : name_(std::move(name)), logged_from_(logged_from), delivery_(delivery) {}

  Message message;  ///< reused message; its constant parts are filled once

  const std::string& name() const { return name_; }
  Delivery delivery() const { return delivery_; }
  LoggedOutputs loggedFrom() const { return logged_from_; }
  /// Attaches a receiver of all further messages, or of those for which `wants` is true. Receivers are called in the
  /// order of their attachment.
  void attach(Deliver deliver, Wants wants = {}) { attached_.push_back({std::move(deliver), std::move(wants)}); }
  bool isWanted() const {
    return std::any_of(attached_.begin(), attached_.end(), [](const Attached& to) { return !to.wants || to.wants(); });
  }
  /// Fills the message by fill(message) and sends it; without a receiver nothing is computed.
  template <typename Fill>
  void send(const ros::Time& record_time, const Fill& fill) {
    ++sent_;
    if (!isWanted()) return;
    fill(message);
    for (const Attached& to : attached_)
      if (!to.wants || to.wants()) to.deliver(message, record_time);
  }
  void send(const ros::Time& record_time) {
    send(record_time, [](const Message&) {});
  }
  std::uint64_t sent() const { return sent_; }  ///< messages since the start, wanted or not

 private:
  struct Attached {
    Deliver deliver;
    Wants wants;  ///< empty: always
  };

  std::string name_;
  LoggedOutputs logged_from_;
  Delivery delivery_;
  std::vector<Attached> attached_;
  std::uint64_t sent_{};
};

constexpr std::uint32_t kTopicQueue =
    10000;  ///< ten seconds at 1 kHz, for inputs and outputs: a stalled computer loses no message

/// Attaches outputs to private topics. Each is published while it has a subscriber and logged while a log that includes
/// it is recording; otherwise it is not computed. A latched output is only logged, since the node itself publishes it.
/// The log must outlive the outputs.
template <typename Outputs>
void attachToNode(Outputs& outputs, ros::NodeHandle& private_node, BagLog& log) {
  outputs.forEach([&](auto& output) {
    using Message = typename std::decay_t<decltype(output)>::Message;
    if (output.delivery() == Delivery::kLatched) {
      output.attach([&log, topic = private_node.resolveName(output.name())](
                        const Message& message, const ros::Time& time) { log.writeLatched(topic, time, message); });
      return;
    }
    const bool last = output.delivery() == Delivery::kLast;
    const ros::Publisher publisher = private_node.advertise<Message>(output.name(), kTopicQueue, last);
    output.attach([publisher](const Message& message, const ros::Time&) { publisher.publish(message); },
                  [publisher, last] { return last || publisher.getNumSubscribers() > 0; });
    if (output.delivery() == Delivery::kOnRequest || !log.logs(output.loggedFrom())) return;
    output.attach([&log, topic = publisher.getTopic()](const Message& message,
                                                       const ros::Time& time) { log.write(topic, time, message); },
                  [&log] { return log.isRecording(); });
  });
}

/// Attaches outputs to topics below a prefix (without / at its end). on_request: outputs of that delivery as well.
template <typename Outputs>
void attachToBag(Outputs& outputs, BagWriter& bag, const std::string& prefix, bool on_request) {
  outputs.forEach([&](auto& output) {
    using Message = typename std::decay_t<decltype(output)>::Message;
    const std::string topic = prefix + "/" + output.name();
    if (output.delivery() == Delivery::kOnRequest && !on_request) return;
    const bool latched = output.delivery() == Delivery::kLatched || output.delivery() == Delivery::kLast;
    output.attach([&bag, topic, latched](const Message& message, const ros::Time& time) {
      bag.write(topic, time, message, latched);
    });
  });
}

}  // namespace hammer_loads
