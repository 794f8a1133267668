// Runs machine time through the log, with splits and deleted oldest bags. Usage: log_soak EMPTY_DIRECTORY [SECONDS]
#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/ros/run_node.h"
#include "hammer_loads/settings/load.h"
#include "soak/endless_session.h"
#include "soak/verdict.h"
#include "support/resident_memory.h"

namespace hammer_loads::soak {
namespace {

namespace fs = std::filesystem;

constexpr char kCrank[] = "/hammer/crank", kWrench[] = "/hammer_loads/hull_wrench";

LogSettings logSettings(const std::string& directory) {
  LogSettings settings;
  settings.enabled = true;
  settings.directory = directory;
  settings.prefix = "soak";
  settings.split_size = 5'000'000;
  settings.total_size = 25'000'000;
  settings.queue_size = 16'000'000;
  return settings;
}

ros::Time timeOf(StampNs stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

/// Bags left in the directory in order, and whether they contain the end of the run without a gap.
struct Kept {
  std::uint64_t messages{}, files{};
  double size{};
  std::uint64_t gaps{};
  std::uint32_t last{};
};

Kept readBack(const std::string& directory) {
  std::vector<std::pair<ros::Time, std::string>> files;
  Kept kept;
  for (const auto& entry : fs::directory_iterator(directory)) {
    rosbag::Bag bag(entry.path().string(), rosbag::bagmode::Read);
    files.emplace_back(rosbag::View(bag).getBeginTime(), entry.path().string());
    kept.size += static_cast<double>(entry.file_size());
  }
  std::sort(files.begin(), files.end());
  kept.files = files.size();
  std::optional<std::uint32_t> previous;
  for (const auto& [begin, path] : files) {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(kWrench))) {
      const std::uint32_t number = instance.instantiate<geometry_msgs::WrenchStamped>()->header.seq;
      kept.gaps += previous && number != *previous + 1;
      previous = number;
      ++kept.messages;
    }
  }
  kept.last = previous.value_or(0);
  return kept;
}

struct Written {
  LogHealth health;
  std::uint32_t wrenches{};
  double most_on_disk{};  ///< [byte]
  test::MemoryRecord memory;
};

double sizeOf(const std::string& directory) {
  double size = 0.0;
  for (const auto& entry : fs::directory_iterator(directory)) {
    std::error_code gone;  // deleted meanwhile
    const auto bytes = entry.file_size(gone);
    if (!gone) size += static_cast<double>(bytes);
  }
  return size;
}

Written write(const std::string& directory, std::uint64_t samples) {
  EndlessSession session(1000.0);
  Pipeline pipeline(*Mechanism::make(session.machine().hammer).value, loadFiles(configDirectory(), {}).value->pipeline);
  BagLog log(logSettings(directory));
  if (!log.start().empty()) throw std::runtime_error("the log does not start");
  sensor_msgs::JointState crank;
  crank.name = {"hammer_crank_joint"};
  geometry_msgs::WrenchStamped wrench;
  wrench.header.frame_id = "hammer_hull";
  Written written;
  for (std::uint64_t i = 0; i < samples; ++i) {
    const EndlessSample sample = session.next();
    crank.header.stamp = wrench.header.stamp = timeOf(sample.stamp);
    crank.position = {sample.crank.angle};
    crank.velocity = {*sample.crank.speed};
    log.write(kCrank, crank.header.stamp, crank);
    const SampleResult& loads = pipeline.crankJoint(sample.stamp, crank.name, crank.position, crank.velocity);
    if (!loads.refusal) {
      wrench.header.seq = ++written.wrenches;
      wrench.wrench.force.x = loads.wrench.force_x;
      wrench.wrench.force.z = loads.wrench.force_z;
      wrench.wrench.torque.y = loads.wrench.torque_y;
      log.write(kWrench, wrench.header.stamp, wrench);
    }
    if (i % 1000 != 0) continue;
    while (log.health().queue_fill > 0.25) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (i % (samples / 400 / 1000 * 1000 + 1000) == 0) {
      if (i > samples / 10) written.memory.add(test::residentMemory());  // by then every buffer has its full size
      written.most_on_disk = std::max(written.most_on_disk, sizeOf(directory));
    }
  }
  log.stop();
  while (log.health().state == LogState::kRecording) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  written.health = log.health();
  return written;
}

int run(const std::string& directory, double machine_seconds) {
  const auto begin = std::chrono::steady_clock::now();
  const Written written = write(directory, static_cast<std::uint64_t>(1000.0 * machine_seconds));
  const LogSettings settings = logSettings(directory);
  const Kept kept = readBack(directory);
  Verdict verdict;
  verdict.tell("machine_seconds", machine_seconds);
  verdict.tell("seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  verdict.tell("messages_written", static_cast<double>(written.health.messages_written));
  verdict.tell("messages_dropped", static_cast<double>(written.health.messages_dropped));
  verdict.tell("written_MB", 1e-6 * static_cast<double>(written.health.bytes_written));
  verdict.tell("bags_closed", static_cast<double>(written.health.files_closed));
  verdict.tell("bags_deleted", static_cast<double>(written.health.files_deleted));
  verdict.tell("most_on_disk_MB", 1e-6 * written.most_on_disk);
  verdict.tell("allowed_MB", 1e-6 * static_cast<double>(settings.total_size));
  verdict.tell("memory_first_quarter_MB", 1e-6 * written.memory.firstQuarter());
  verdict.tell("memory_last_quarter_MB", 1e-6 * written.memory.lastQuarter());
  verdict.tell("gaps", static_cast<double>(kept.gaps));
  verdict.tell("wrenches_kept", static_cast<double>(kept.messages));
  verdict.demand(written.health.state == LogState::kOff, "the log ends well: " + written.health.reason);
  verdict.demand(written.health.messages_dropped == 0, "no message dropped");
  verdict.demand(written.health.files_deleted > 0, "old bags deleted");
  verdict.demand(kept.files == written.health.files_closed - written.health.files_deleted,
                 "only bags deleted that count");
  verdict.demand(written.most_on_disk <= static_cast<double>(settings.total_size + 2 * settings.split_size),
                 "no more on the disk than allowed and the bag being written");
  verdict.demand(kept.gaps == 0 && kept.last == written.wrenches,
                 "the bags kept hold the end of the run without a gap");
  verdict.demand(std::abs(written.memory.growth()) <= 0.01, "memory of the last quarter within 1 % of the first");
  return verdict.exitCode();
}

}  // namespace
}  // namespace hammer_loads::soak

int main(int argc, char** argv) {
  hammer_loads::keepMemorySteady();  // as in the nodes
  const double seconds = argc > 2 ? std::strtod(argv[2], nullptr) : 3600.0;
  if (argc < 2 || argc > 3 || !(seconds >= 600.0) || !std::filesystem::is_empty(argv[1])) {
    std::fprintf(stderr, "usage: log_soak EMPTY_DIRECTORY [SECONDS], at least 600\n");
    return 2;
  }
  return hammer_loads::soak::run(argv[1], seconds);
}
