/// One output topic: its message is filled in place and sent to all attached receivers.
#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/log/log_settings.h"

namespace hammer_loads {

enum class Delivery {
  kEach,
  kOnRequest,  ///< left out of every log, and of bags unless asked for
  kLast,       ///< late subscribers get the last one
  kLatched,    ///< one message per run, repeated for late subscribers and in every file
};

template <typename MessageType>
class Output {
 public:
  using Message = MessageType;
  /// record_time: that of the input that caused the message.
  using Deliver = std::function<void(const Message&, const ros::Time& record_time)>;
  using Wants = std::function<bool()>;

  /// name: below the node's private name space or the prefix of a bag's outputs. logged_from: least log_outputs that
  /// logs it.
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
  void detachAll() { attached_.clear(); }
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

}  // namespace hammer_loads
