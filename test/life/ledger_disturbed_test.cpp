// Ledgers that others write, lock, replace or remove, or on a full disk: no load is lost and nothing else is added.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "hammer_loads/life/database.h"
#include "life/ledger_support.h"

namespace hammer_loads::life {
namespace {

using namespace test;

TEST(Ledger, TwoWritersTakeTurnsAndLoseNothing) {
  const LedgerFile file;
  LifeRecorder a = recorder(), b = recorder(), whole = recorder();
  LedgerRun first(file.path(), machine(), "a"), second(file.path(), machine(), "b");
  Loads loads_a(1), loads_b(2), whole_a(1), whole_b(2);
  for (int i = 0; i < 3; ++i) {
    loads_a.feed(a, 100);
    EXPECT_EQ(first.add(a.take()), kWritten);
    loads_b.feed(b, 100);
    EXPECT_EQ(second.add(b.take()), kWritten);
  }
  EXPECT_EQ(first.end({}), kWritten);
  EXPECT_EQ(second.end({}), kWritten);
  whole_a.feed(whole, 300);
  whole_b.feed(whole, 300);
  EXPECT_EQ(statesOf(contentsOf(file.path()).totals.at(0)), statesOf(whole.take().counts));
}

TEST(Ledger, ALockedFileCostsNothingButTime) {
  for (const char* sql : {"BEGIN EXCLUSIVE", "BEGIN; SELECT * FROM runs"}) {
    const LedgerFile file;
    LifeRecorder part = recorder(), whole = recorder();
    Loads loads(3), same(3);
    LedgerRun run(file.path(), machine(), "a");
    loads.feed(part, 500);
    EXPECT_EQ(run.add(part.take()), kWritten);
    {
      const Holder holder(file.path(), sql);
      loads.feed(part, 500);
      EXPECT_EQ(run.add(part.take()), file.path() + ": database is locked");
    }
    loads.feed(part, 500);
    EXPECT_EQ(run.end(part.take()), kWritten);
    same.feed(whole, 1500);
    EXPECT_EQ(statesOf(contentsOf(file.path()).totals.at(0)), statesOf(whole.take().counts)) << sql;
  }
}

/// Runs in a process with a file size limit, which acts like a full disk.
TEST(Ledger, AFullDiskCostsNothingButTime) {
  const LedgerFile file;
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    LifeRecorder part = recorder();
    Loads loads(4);
    LedgerRun run(file.path(), machine(), "a");
    loads.feed(part, 50);
    bool right = !run.add(part.take());
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlim_t most = limit.rlim_cur;
    limit.rlim_cur = std::filesystem::file_size(file.path());
    right = setrlimit(RLIMIT_FSIZE, &limit) == 0 && right;
    loads.feed(part, 20000);
    right = run.add(part.take()).has_value() && right;
    right = run.add(part.take()).has_value() && right;
    limit.rlim_cur = most;
    right = setrlimit(RLIMIT_FSIZE, &limit) == 0 && right;
    loads.feed(part, 50);
    right = !run.end(part.take()) && right;
    _exit(right ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  LifeRecorder whole = recorder();
  Loads(4).feed(whole, 20100);
  EXPECT_EQ(statesOf(contentsOf(file.path()).totals.at(0)), statesOf(whole.take().counts));
}

TEST(Ledger, LookingLeavesNothingBehind) {
  const LedgerFile file;
  std::ofstream(file.path("text")) << std::string(2000, 'x');
  EXPECT_EQ(ledgerProblem(file.path("text")), file.path("text") + ": file is not a database");
  EXPECT_EQ(ledgerProblem(file.path()), "");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(file.path()).parent_path()))
    names.push_back(entry.path().filename());
  EXPECT_EQ(names, std::vector<std::string>{"text"});
}

TEST(Ledger, AnythingElseInItsPlaceIsLeftAsItIs) {
  const LedgerFile file;
  LifeRecorder part = recorder();
  Loads(5).feed(part, 100);
  const LifePiece piece = part.take();
  const auto refused = [&](const std::string& path, const std::string& why) {
    LedgerRun run(path, machine(), "a");
    const Problem problem = run.add(piece);
    EXPECT_TRUE(problem && problem->find(why) != std::string::npos) << problem.value_or("(written)");
    EXPECT_EQ(run.waiting(), 1U);
  };
  std::ofstream(file.path("text")) << std::string(2000, 'x');
  refused(file.path("text"), "not a database");
  Database(file.path("other"), Database::Use::kWrite, 0).run("CREATE TABLE mine(a)");
  refused(file.path("other"), "is another database, no ledger");
  std::filesystem::create_directory(file.path("directory"));
  refused(file.path("directory"), "is no regular file");
  refused("/dev/null", "is no regular file");
  refused(file.path("no/such/place"), "No such file or directory");
  EXPECT_EQ(LedgerRun(file.path(), machine(), "a").end(piece), kWritten);
  Database(file.path(), Database::Use::kWrite, 0).run("PRAGMA user_version = 99");
  refused(file.path(), "a ledger of version 99, must be 1");
  EXPECT_NE(contentsOf(file.path()).problem.find("version 99"), std::string::npos);
  for (const char* name : {"text", "other", "directory", "none"}) EXPECT_NE(contentsOf(file.path(name)).problem, "");
  std::ofstream(file.path("empty")).close();  // remains of a kill at the very start
  EXPECT_EQ(LedgerRun(file.path("empty"), machine(), "a").end(piece), kWritten);
}

TEST(Ledger, StartsAFileThatIsTakenAwayAgain) {
  const LedgerFile file;
  LifeRecorder part = recorder(), after = recorder();
  Loads loads(6);
  LedgerRun run(file.path(), machine(), "a");
  loads.feed(part, 100);
  EXPECT_EQ(run.add(part.take()), kWritten);
  std::filesystem::remove(file.path());
  loads.feed(part, 100);
  EXPECT_EQ(run.end(part.take()), kWritten);
  EXPECT_EQ(contentsOf(file.path()).totals.at(0)[0].tally.counted, 100U);
}

}  // namespace
}  // namespace hammer_loads::life
