// kill -9 at random instants: the ledger opens, counts nothing twice and lacks at most the last period.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "life/ledger_support.h"

namespace hammer_loads::life {
namespace {

using namespace test;

constexpr int kSamples = 200;  // of a period

/// Adds one period after the other until it is killed and reports each to the pipe once it is in the ledger.
[[noreturn]] void work(const std::string& path, unsigned run, int pipe) {
  LifeRecorder part = recorder();
  Loads loads(run);
  LedgerRun ledger(path, machine(), std::to_string(run));
  while (true) {
    loads.feed(part, kSamples);
    const bool written = !ledger.add(part.take());
    if (write(pipe, written ? "." : "!", 1) != 1) _exit(1);
  }
}

TEST(LedgerKill, FiftyKillsLoseAtMostAPeriodEach) {
  const LedgerFile file;
  LifeRecorder whole = recorder();
  std::mt19937 random(1);
  std::int64_t known_samples = 0;
  int lost = 0;
  for (unsigned run = 0; run < 50; ++run) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) work(file.path(), run, ends[1]);
    close(ends[1]);
    char mark = 0;
    std::int64_t reported = 0;
    // Kills some microseconds after one of the first periods, including the very first.
    for (auto wait = random() % 4; wait > 0 && read(ends[0], &mark, 1) == 1; --wait) ++reported;
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    ASSERT_EQ(kill(child, SIGKILL), 0);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    while (read(ends[0], &mark, 1) == 1) ++reported;
    close(ends[0]);
    ASSERT_NE(mark, '!');

    if (!std::filesystem::exists(file.path()) || std::filesystem::file_size(file.path()) == 0) {
      ASSERT_EQ(reported, 0);
      continue;
    }
    const Contents contents = contentsOf(file.path());
    if (reported == 0 && known_samples == 0 && contents.problem.find("holds no ledger") != std::string::npos) continue;
    ASSERT_EQ(contents.problem, "");
    const auto now = static_cast<std::int64_t>(contents.totals.at(0)[0].tally.counted);
    const std::int64_t added = (now - known_samples) / kSamples;
    ASSERT_EQ((now - known_samples) % kSamples, 0);
    ASSERT_GE(added, reported);
    ASSERT_LE(added, reported + 1);
    lost += added == reported ? 1 : 0;
    known_samples = now;
    Loads(run).feed(whole, static_cast<int>(added) * kSamples);
  }
  LifePiece expected = whole.take();
  EXPECT_EQ(statesOf(contentsOf(file.path()).totals.at(0)), statesOf(expected.counts));
  EXPECT_GT(known_samples, 0);
  std::printf("50 kills: the period at work lost %d times, %ld samples kept\n", lost, static_cast<long>(known_samples));
}

}  // namespace
}  // namespace hammer_loads::life
