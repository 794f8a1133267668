// Measures the time from publishing a crank sample to its wrench for the live node, a nodelet here and a bare relay.
// The paths run in turn, so that each has the machine to itself. Usage: latency_probe RATE_HZ ROUNDS
// Prints CSV: rate_Hz,path,quantile,microseconds. Quantile "ratio" is the median over rounds of the ratio of the path's
// median to the relay's.
#include <geometry_msgs/WrenchStamped.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <limits>

namespace hammer_loads {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBlock = 250;  // samples of one path before the next path follows
constexpr std::uint32_t kQueue = 10000;
constexpr std::size_t kMemory = 1024;  // sending times kept: more than a block

double quantile(std::vector<double> values, double part) {
  const auto at = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// A path from a sample to its answer.
struct Path {
  std::string name;
  ros::Publisher publisher;
  ros::Subscriber subscriber;
  std::vector<double> all, block, medians;  ///< [us]; medians: one per round
  std::size_t number{};                     ///< of the last sample
  ros::Time sent;                           ///< its stamp
  std::array<Clock::time_point, kMemory> times{};
};

class Probe {
 public:
  explicit Probe(double rate) : rate_(rate) {
    connect<geometry_msgs::WrenchStamped>(paths_[0], "node", "crank", "hammer_loads/hull_wrench");
    connect<geometry_msgs::WrenchStamped>(paths_[1], "nodelet", "crank_of_nodelet", "nodelet_loads/hull_wrench");
    connect<sensor_msgs::JointState>(paths_[2], "relay", "crank_of_relay", "relayed");
  }

  bool connected() {
    ros::param::set("nodelet_loads/log_enabled", false);
    ros::param::set("nodelet_loads/crank_zero_std_rad", 0.003);  // a known zero: no sample is withheld for it
    const std::string loads = ros::names::resolve("nodelet_loads");
    const ros::M_string remappings{{ros::names::resolve("crank"), ros::names::resolve("crank_of_nodelet")}};
    if (!loader_.load(loads, "hammer_loads/HammerLoadsNodelet", remappings, {})) return false;
    return std::all_of(paths_.begin(), paths_.end(), [this](Path& path) {
      return wait([&] {
        send(path);  // a relay advertises at its first message
        return path.publisher.getNumSubscribers() > 0 && path.subscriber.getNumPublishers() > 0;
      });
    });
  }

  bool run(int rounds) {
    for (int round = 0; round < rounds + 1; ++round) {
      for (Path& path : paths_) {
        path.block.clear();
        measure(path);
        // topic_tools' relay keeps ten messages and loses some on a loaded machine. A lost message counts as later than
        // any other; the other paths may lose none.
        const std::size_t least = &path == &paths_.back() ? kBlock / 10 : kBlock;
        if (path.block.size() < least) {
          std::fprintf(stderr, "%s: %zu answers to %d samples\n", path.name.c_str(), path.block.size(), kBlock);
          return false;
        }
        path.block.resize(kBlock, std::numeric_limits<double>::infinity());
        if (round == 0) continue;  // to warm up
        path.all.insert(path.all.end(), path.block.begin(), path.block.end());
        path.medians.push_back(quantile(path.block, 0.5));
      }
    }
    return true;
  }

  void print() const {
    for (const Path& path : paths_) {
      for (const double part :
           {0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9995})
        std::printf("%g,%s,%g,%.1f\n", rate_, path.name.c_str(), part, quantile(path.all, part));
      std::vector<double> ratios;
      for (std::size_t i = 0; i < path.medians.size(); ++i) ratios.push_back(path.medians[i] / paths_[2].medians[i]);
      std::printf("%g,%s,ratio,%.3f\n", rate_, path.name.c_str(), quantile(ratios, 0.5));
    }
  }

 private:
  template <typename Answer>
  void connect(Path& path, const char* name, const char* to, const char* from) {
    path.name = name;
    path.publisher = node_.advertise<sensor_msgs::JointState>(to, kQueue);
    path.subscriber = node_.subscribe<Answer>(
        from, kQueue, [this, &path](const typename Answer::ConstPtr& answer) { arrived(path, answer->header.stamp); },
        {}, ros::TransportHints().tcpNoDelay());
  }

  template <typename Condition>
  bool wait(Condition condition, double seconds = 20.0) {
    const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
    while (!condition() && Clock::now() < deadline)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    return condition();
  }

  /// Publishes a crank at 4 rad/s, from 1 rad after the blow on. No sample is withheld, neither beside a blow nor at
  /// the start. The stamp is the number of the sample.
  void send(Path& path) {
    const auto message = boost::make_shared<sensor_msgs::JointState>();
    message->name = {"hammer_crank_joint"};
    message->header.stamp.fromNSec(1000000000000 + static_cast<std::uint64_t>(1e9 / rate_) * ++path.number);
    message->position = {1.0 + 4.0 / rate_ * static_cast<double>(path.number)};
    message->velocity = {4.0};
    path.sent = message->header.stamp;
    path.publisher.publish(message);
  }

  void arrived(Path& path, const ros::Time& stamp) {
    const auto now = Clock::now();
    const auto behind = static_cast<std::size_t>(std::llround((path.sent - stamp).toSec() * rate_));
    if (behind >= kMemory) return;
    path.block.push_back(
        std::chrono::duration<double, std::micro>(now - path.times[(path.number - behind) % kMemory]).count());
  }

  void measure(Path& path) {
    wait([] { return false; }, 0.02);
    path.block.clear();
    const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_));
    Clock::time_point due = Clock::now();
    for (int i = 0; i < kBlock; ++i) {
      due += period;
      while (Clock::now() < due) {
        const double left = std::chrono::duration<double>(due - Clock::now()).count();
        ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(std::max(0.0, left)));
      }
      path.times[(path.number + 1) % kMemory] = Clock::now();
      send(path);
    }
    wait([&] { return path.block.size() >= kBlock; }, 1.0);
  }

  ros::NodeHandle node_;
  nodelet::Loader loader_{false};
  std::array<Path, 3> paths_;
  double rate_;
};

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  ros::init(argc, argv, "latency_probe");
  const double rate = argc == 3 ? std::strtod(argv[1], nullptr) : 0.0;
  const int rounds = argc == 3 ? std::atoi(argv[2]) : 0;
  if (!(rate >= 10.0) || rounds < 1) {
    std::fprintf(stderr, "usage: latency_probe RATE_HZ ROUNDS\n");
    return 2;
  }
  hammer_loads::Probe probe(rate);
  if (!probe.connected()) {
    std::fprintf(stderr, "node, nodelet or relay does not answer\n");
    return 1;
  }
  if (!probe.run(rounds)) return 1;
  probe.print();
  return 0;
}
