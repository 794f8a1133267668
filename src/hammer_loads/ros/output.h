/// One output topic: declared once, its message filled in place, sent to whatever is attached.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace hammer_loads {

enum class Delivery {
  kLogged,     ///< published and logged
  kOnRequest,  ///< published, but left out of logs and bags unless asked for: it follows from what they hold
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
  void attach(Deliver deliver) { deliver_ = std::move(deliver); }
  void send(const ros::Time& record_time) {
    ++sent_;
    if (deliver_) deliver_(message, record_time);
  }
  std::uint64_t sent() const { return sent_; }  ///< messages since the start

 private:
  std::string name_;
  Delivery delivery_;
  Deliver deliver_;
  std::uint64_t sent_{};
};

}  // namespace hammer_loads
