/// Destinations of a table of outputs: a node's topics and its log, or a bag.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>
#include <type_traits>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/bag_writer.h"
#include "hammer_loads/ros/output.h"

namespace hammer_loads {

constexpr std::uint32_t kTopicQueue =
    10000;  ///< ten seconds at 1 kHz, for inputs and outputs: a stalled machine loses no message

/// Private topics. Each is published while it has a subscriber and logged while a log that wants it records; otherwise
/// it is not computed. A latched output is only logged, since the node itself publishes it. The log must outlive the
/// outputs.
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

/// Topics below a prefix (without / at its end). on_request: outputs of that delivery as well.
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
