// A ledger written by a separate thread equals one written piece by piece.
#include "hammer_loads/life/ledger_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"
#include "life/ledger_support.h"
#include "support/resident_memory.h"

namespace hammer_loads::life {
namespace {

using namespace test;

/// Feeds two runs of some pieces each into any sink.
void work(PieceSink& sink) {
  for (unsigned run = 0; run < 2; ++run) {
    LifeRecorder part = recorder();
    Loads loads(run);
    sink.begin(machine(), "run " + std::to_string(run));
    for (int piece = 0; piece < 4; ++piece) {
      loads.feed(part, 300);
      sink.add(part.take());
    }
    loads.feed(part, 50);
    sink.end(part.take());
  }
}

Contents pieceByPiece(const std::string& path) {
  class Direct final : public PieceSink {
   public:
    explicit Direct(std::string ledger) : path_(std::move(ledger)) {}
    void begin(const LedgerMachine& of, const RunId& run) override { run_.emplace(path_, of, run); }
    void add(const LifePiece& piece) override { EXPECT_EQ(run_->add(piece), Problem()); }
    void refuse(const std::string& reason) override { run_->refuse(reason); }
    void end(const LifePiece& last) override { EXPECT_EQ(run_->end(last), Problem()); }

   private:
    std::string path_;
    std::optional<LedgerRun> run_;
  } direct(path);
  work(direct);
  return contentsOf(path);
}

void expectTheSame(const Contents& contents, const Contents& expected) {
  EXPECT_EQ(contents.problem, "");
  ASSERT_EQ(contents.epochs.size(), expected.epochs.size());
  for (std::size_t i = 0; i < expected.epochs.size(); ++i) {
    EXPECT_EQ(contents.epochs[i].runs, expected.epochs[i].runs);
    EXPECT_EQ(statesOf(contents.totals[i]), statesOf(expected.totals[i]));
    ASSERT_EQ(contents.epochs[i].days.size(), expected.epochs[i].days.size());
    EXPECT_EQ(contents.epochs[i].days[0].turns, expected.epochs[i].days[0].turns);
    EXPECT_EQ(contents.epochs[i].days[0].duration, expected.epochs[i].days[0].duration);
  }
}

bool comesTrue(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

/// Each piece has thirty thousand kinds of cycles, half a megabyte.
TEST(LedgerThread, PiecesThatWaitForTheDiskAreAddedUp) {
  const LedgerFile file;
  LedgerThread thread(file.path());
  LifeRecorder part = recorder(settings(4096));
  Loads loads(3);
  loads.feed(part, 60000);
  LifePiece piece = part.take();
  thread.begin(machine("mo100", settings(4096)), "a");
  thread.add(piece);
  ASSERT_TRUE(comesTrue([&] { return contentsOf(file.path()).epochs.size() == 1U; }));
  Database other(file.path(), Database::Use::kRead, 20000);
  other.run("BEGIN EXCLUSIVE");
  ASSERT_TRUE(other.good()) << other.problem();
  piece.marks.clear();
  const double before = ::hammer_loads::test::residentMemory();
  for (int i = 0; i < 200; ++i) thread.add(piece);
  EXPECT_LT(::hammer_loads::test::residentMemory() - before, 2e7);
  other.run("COMMIT");
  thread.end(recorder(settings(4096)).take());
  EXPECT_EQ(thread.close(), Problem());
  EXPECT_EQ(contentsOf(file.path()).totals.at(0)[0].tally.counted, 201U * 60000U);
}

TEST(LedgerThread, WaitsForAnotherWriterAndReportsIt) {
  const LedgerFile file;
  const Contents expected = pieceByPiece(file.path("direct.sqlite"));
  std::optional<Holder> other(std::in_place, file.path(), "BEGIN EXCLUSIVE");
  LedgerThread thread(file.path());
  work(thread);
  ASSERT_TRUE(comesTrue([&] { return thread.state().waiting > 0; }));
  EXPECT_EQ(thread.state().problem, file.path() + ": database is locked");
  other.reset();
  EXPECT_TRUE(comesTrue([&] { return thread.state().problem.empty(); }));
  EXPECT_EQ(thread.close(), Problem());
  expectTheSame(contentsOf(file.path()), expected);
}

TEST(LedgerThread, ReportsAtItsEndWhatIsNotWritten) {
  const LedgerFile file;
  std::ofstream(file.path()) << "no ledger at all, but a text that is long enough to be taken for one, or so it seems";
  const std::string before = file.bytes();
  LedgerThread thread(file.path());
  work(thread);
  const Problem problem = thread.close();
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->find(file.path() + ": "), 0U) << *problem;
  EXPECT_GE(thread.state().waiting, 2U);
  EXPECT_EQ(file.bytes(), before);
}

TEST(LedgerBatch, WritesWhatPiecesWouldGiveAndNothingTwice) {
  const LedgerFile file;
  const Contents expected = pieceByPiece(file.path("direct.sqlite"));
  for (const std::size_t times : {0U, 1U}) {
    LedgerBatch batch(file.path());
    EXPECT_EQ(batch.check(), "");
    work(batch);
    std::vector<std::string> known;
    EXPECT_EQ(batch.write(known), "");
    EXPECT_EQ(batch.commit(), "");
    EXPECT_EQ(known.size(), 2 * times);
    expectTheSame(contentsOf(file.path()), expected);
  }
}

TEST(LedgerBatch, TouchesNothingBeforeItWrites) {
  const LedgerFile file;
  LedgerBatch batch(file.path());
  EXPECT_EQ(batch.check(), "");
  work(batch);
  EXPECT_FALSE(std::filesystem::exists(file.path()));
  std::filesystem::create_directory(file.path("directory.sqlite"));
  EXPECT_NE(LedgerBatch(file.path("directory.sqlite")).check(), "");
  EXPECT_NE(LedgerBatch(file.path("no/such.sqlite")).check(), "");
}

}  // namespace
}  // namespace hammer_loads::life
