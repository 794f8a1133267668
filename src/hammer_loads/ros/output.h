/// One output topic: declared once, its message filled in place, sent to whatever is attached.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace hammer_loads {

enum class Delivery {
  kLogged,     ///< published and logged
  kOnRequest,  ///< published, but left out of logs and bags unless asked for: it follows from what they hold
  kLast,       ///< published and logged; late subscribers get the last one
  kLatched,    ///< one message per run, repeated for late subscribers and in every file
};

template <typename MessageType>
class Output {
 public:
  using Message = MessageType;
  /// record_time: that of the input that caused the message.
  using Deliver = std::function<void(const Message&, const ros::Time& record_time)>;

  /// name: below the node's private name space or the prefix of a bag's outputs.
  explicit Output(std::string name, Delivery delivery = Delivery::kLogged)
      : name_(std::move(name)), delivery_(delivery) {}

  Message message;  ///< what does not change from one to the next is filled once

  const std::string& name() const { return name_; }
  Delivery delivery() const { return delivery_; }
  /// What is attached takes every message from now on, in the order of attaching.
  void attach(Deliver deliver) { attached_.push_back(std::move(deliver)); }
  void detachAll() { attached_.clear(); }
  /// Whether a message goes anywhere: else what only the message shows need not be computed.
  bool attached() const { return !attached_.empty(); }
  void send(const ros::Time& record_time) {
    ++sent_;
    for (const Deliver& deliver : attached_) deliver(message, record_time);
  }
  std::uint64_t sent() const { return sent_; }  ///< messages since the start

 private:
  std::string name_;
  Delivery delivery_;
  std::vector<Deliver> attached_;
  std::uint64_t sent_{};
};

}  // namespace hammer_loads
