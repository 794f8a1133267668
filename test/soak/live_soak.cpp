// Sends crank samples to the live node and receives every wrench. Usage: live_soak SECONDS RATE_HZ NODE_PID
#include <geometry_msgs/WrenchStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <chrono>
#include <cstdlib>
#include <deque>

#include "soak/endless_session.h"
#include "soak/verdict.h"
#include "support/resident_memory.h"

namespace hammer_loads::soak {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kQueue = 1000000;

/// Checks that stamps return in the order of sending, each once.
class LiveSoak {
 public:
  explicit LiveSoak(double rate) : session_(rate), rate_(rate) {
    crank_ = node_.advertise<sensor_msgs::JointState>("crank", kQueue);
    wrench_ = node_.subscribe("hammer_loads/hull_wrench", kQueue, &LiveSoak::arrived, this,
                              ros::TransportHints().tcpNoDelay());
    message_.name = {"hammer_crank_joint"};
  }

  bool connected() {
    return wait([this] { return crank_.getNumSubscribers() > 0 && wrench_.getNumPublishers() > 0; });
  }

  void run(double seconds, const std::string& node_process) {
    const auto begin = Clock::now();
    const auto count = static_cast<std::uint64_t>(seconds * rate_);
    while (sent_ < count && ros::ok()) {
      const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
      const auto due = std::min(count, static_cast<std::uint64_t>(elapsed * rate_));
      while (sent_ < due) send();
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(5e-4));
      if (elapsed > seconds / 400.0 * static_cast<double>(memory_samples_)) {
        memory.add(test::residentMemory(node_process));
        ++memory_samples_;
      }
    }
    wait([this] { return last_received_ == message_.header.stamp.toNSec(); });
  }

  test::MemoryRecord memory;
  std::uint64_t sent() const { return sent_; }
  std::uint64_t received() const { return received_; }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t doubled() const { return doubled_; }
  std::uint64_t unsettled() const { return unsettled_; }

 private:
  template <typename Condition>
  bool wait(Condition condition) {
    const auto deadline = Clock::now() + std::chrono::seconds(20);
    while (!condition() && Clock::now() < deadline)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    return condition();
  }

  void send() {
    const EndlessSample sample = session_.next();
    message_.header.stamp.fromNSec(static_cast<std::uint64_t>(sample.stamp));
    message_.position = {sample.crank.angle};
    message_.velocity = {*sample.crank.speed};
    pending_.push_back(message_.header.stamp.toNSec());
    ++sent_;
    crank_.publish(message_);
  }

  void arrived(const geometry_msgs::WrenchStamped& message) {
    const std::uint64_t stamp = message.header.stamp.toNSec();
    if (stamp <= last_received_) {
      ++doubled_;
      return;
    }
    for (; !pending_.empty() && pending_.front() != stamp; pending_.pop_front())
      ++(received_ == 0 ? unsettled_ : lost_);
    if (!pending_.empty()) pending_.pop_front();
    last_received_ = stamp;
    ++received_;
  }

  ros::NodeHandle node_;
  ros::Publisher crank_;
  ros::Subscriber wrench_;
  EndlessSession session_;
  sensor_msgs::JointState message_;
  std::deque<std::uint64_t> pending_;
  double rate_;
  std::uint64_t sent_{}, received_{}, lost_{}, doubled_{}, unsettled_{}, last_received_{}, memory_samples_{};
};

int run(double seconds, double rate, const std::string& node_process) {
  LiveSoak soak(rate);
  Verdict verdict;
  verdict.demand(soak.connected(), "the node must be there");
  if (verdict.exitCode() != 0) return 1;
  soak.run(seconds, node_process);
  verdict.tell("seconds", seconds);
  verdict.tell("rate_Hz", rate);
  verdict.tell("sent", static_cast<double>(soak.sent()));
  verdict.tell("received", static_cast<double>(soak.received()));
  verdict.tell("before_the_first_wrench", static_cast<double>(soak.unsettled()));
  verdict.tell("lost", static_cast<double>(soak.lost()));
  verdict.tell("doubled", static_cast<double>(soak.doubled()));
  verdict.tell("node_memory_first_quarter_MB", 1e-6 * soak.memory.firstQuarter());
  verdict.tell("node_memory_last_quarter_MB", 1e-6 * soak.memory.lastQuarter());
  verdict.demand(soak.received() + soak.unsettled() == soak.sent() && soak.lost() == 0, "no wrench lost");
  verdict.demand(soak.unsettled() <= 10, "a wrench from the first samples on");
  verdict.demand(soak.doubled() == 0, "no wrench doubled");
  // A stall of the computer fills the node's queues for a moment, and the heap keeps their size.
  constexpr double kQueues = 4e6;  // [byte]: some 10000 messages
  verdict.demand(soak.memory.lastQuarter() - soak.memory.firstQuarter() <= kQueues,
                 "memory grows by the queues at most");
  return verdict.exitCode();
}

}  // namespace
}  // namespace hammer_loads::soak

int main(int argc, char** argv) {
  ros::init(argc, argv, "live_soak");
  const double seconds = argc == 4 ? std::strtod(argv[1], nullptr) : 0.0,
               rate = argc == 4 ? std::strtod(argv[2], nullptr) : 0.0;
  if (!(seconds >= 5.0) || !(rate >= 100.0)) {
    std::fprintf(stderr, "usage: live_soak SECONDS RATE_HZ NODE_PID\n");
    return 2;
  }
  return hammer_loads::soak::run(seconds, rate, argv[3]);
}
