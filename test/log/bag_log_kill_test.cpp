/// The log when its process ends suddenly.
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <iterator>

#include "hammer_loads/log/bag_log.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

constexpr std::size_t kProcesses = 4;
constexpr std::size_t kEvery[] = {1, 10, 100};  // ms between the messages of each topic

/// Counts in memory that outlives the counting process.
struct Counts {
  std::atomic<std::uint32_t> written[std::size(kEvery)];
};

/// Logs until the process is killed.
void logUntilKilled(const LogSettings& settings, Counts& counts) {
  BagLog log(settings);
  if (!log.start().empty()) std::exit(1);
  log.writeLatched("/run_info", at(0), wrench(0));
  for (std::size_t i = 0;; ++i) {
    // The loop never catches up, so a second holds no more messages than that even on a busy computer.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    for (std::size_t k = 0; k < std::size(kEvery); ++k) {
      if (i % kEvery[k] != 0) continue;
      log.write("/t" + std::to_string(k), at(i), wrench(i));
      ++counts.written[k];
    }
  }
}

TEST_F(LogTest, KillLosesAtMostTheLastSecond) {
  void* shared = mmap(nullptr, kProcesses * sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto* counts = static_cast<Counts*>(shared);  // all zero
  std::vector<pid_t> children;
  for (std::size_t p = 0; p < kProcesses; ++p) {
    settings_.prefix = "p" + std::to_string(p);
    children.push_back(fork());
    if (children.back() == 0) logUntilKilled(settings_, counts[p]);
  }
  for (std::size_t p = 0; p < kProcesses; ++p) {  // at any phase of the chunk
    const std::uint32_t until = static_cast<std::uint32_t>(1500 + 170 * p);
    EXPECT_TRUE(waitFor([&] { return counts[p].written[0] >= until; }));
    kill(children[p], SIGKILL);
    waitpid(children[p], nullptr, 0);
  }
  ASSERT_EQ(files(".active").size(), kProcesses);
  std::string command = "/usr/bin/env rosbag reindex --quiet";
  for (const std::string& file : files(".active")) {
    const std::string closed = file.substr(0, file.rfind('.'));
    std::filesystem::rename(file, closed);
    command += ' ' + closed;
  }
  ASSERT_EQ(std::system((command + " > /dev/null").c_str()), 0) << command;
  for (std::size_t p = 0; p < kProcesses; ++p) {
    std::vector<Entry> entries;
    for (const std::string& file : files())
      if (file.find("/p" + std::to_string(p)) != std::string::npos && file.find(".orig.") == std::string::npos)
        entries = readBag(file);
    EXPECT_EQ(onTopic(entries, "/run_info").size(), 1u);
    for (std::size_t k = 0; k < std::size(kEvery); ++k) {
      const auto kept = onTopic(entries, "/t" + std::to_string(k));
      for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(kept[i].time, at(i * kEvery[k]));  // no hole
      const double lost = 1e-3 * static_cast<double>(kEvery[k] * (counts[p].written[k] - kept.size()));
      EXPECT_LE(lost, 1.0) << "process " << p << " topic " << k << " kept " << kept.size();
      RecordProperty("lost_s_process" + std::to_string(p) + "_topic" + std::to_string(k), std::to_string(lost));
    }
  }
  munmap(shared, kProcesses * sizeof(Counts));
}

}  // namespace
}  // namespace hammer_loads::test
