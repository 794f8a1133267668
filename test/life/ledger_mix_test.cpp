// Any mix of interrupted runs, replays, corrections, parts and names gives the ledger of the recordings, each once.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"
#include "life/ledger_support.h"

namespace hammer_loads::life {
namespace {

using namespace test;

constexpr int kPieces = 5, kSamplesOfPiece = 120;

/// Part of a recording in pieces, as counted by a node or process_bag; `wrong`: with other sensor parameters.
struct Part {
  unsigned recording{};
  int first{}, last{kPieces};
  bool wrong{};
};

RunId idOf(const Part& part) {
  RunId id(std::to_string(part.recording) + "-" + std::to_string(part.first));
  id.parameters = part.wrong ? "wrong" : "right";
  return id;
}

std::vector<LifePiece> piecesOf(const Part& part) {
  LifeRecorder count = recorder();
  Loads skipped(part.recording + (part.wrong ? 1000U : 0U));
  LifeRecorder unused = recorder();
  skipped.feed(unused, part.first * kSamplesOfPiece);
  std::vector<LifePiece> pieces;
  for (int i = part.first; i < part.last; ++i) {
    skipped.feed(count, kSamplesOfPiece);
    pieces.push_back(count.take());
    pieces.back().messages = kSamplesOfPiece;
    pieces.back().marks = {100 * static_cast<std::int64_t>(part.recording) + i};
  }
  return pieces;
}

/// Counts a part as process_bag does. Returns its message; empty if it is counted now or was before.
std::string batch(const std::string& path, const Part& part, bool replace) {
  LedgerBatch ledger(path, replace);
  ledger.begin(machine(), idOf(part));
  for (const LifePiece& piece : piecesOf(part)) ledger.add(piece);
  std::vector<std::string> known;
  std::string problem = ledger.write(known);
  return problem.empty() ? ledger.commit() : problem;
}

/// Runs a live node and kills it after some pieces.
void killed(const std::string& path, const Part& part, int after) {
  const pid_t child = fork();
  if (child == 0) {
    LedgerRun run(path, machine(), idOf(part));
    const std::vector<LifePiece> pieces = piecesOf(part);
    for (int i = 0; i < after; ++i) run.add(pieces[static_cast<std::size_t>(i)]);
    kill(getpid(), SIGKILL);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
}

std::vector<std::string> figures(const std::string& path) {
  const Contents contents = contentsOf(path);
  EXPECT_EQ(contents.problem, "");
  if (contents.epochs.size() != 1) return {"no single epoch"};
  std::vector<std::string> all = statesOf(contents.totals[0]);
  for (const LedgerDay& day : contents.epochs[0].days)
    all.push_back(day.date + " " + std::to_string(day.turns) + " " + std::to_string(day.duration));
  all.push_back(std::to_string(contents.epochs[0].runs));
  return all;
}

TEST(LedgerMix, IsTheWholeRecordingsEachOnce) {
  const LedgerFile file;
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    const std::string path = file.path("mix" + std::to_string(seed)), soft = file.path("soft" + std::to_string(seed));
    std::filesystem::create_symlink(path, soft);
    std::vector<unsigned> order;
    const auto name = [&] { return random() % 2 == 0 ? soft : path; };
    for (int step = 0; step < 12; ++step) {
      Part part{static_cast<unsigned>(random() % 4)};
      if (std::find(order.begin(), order.end(), part.recording) == order.end()) order.push_back(part.recording);
      switch (random() % 5) {
        case 0:
          killed(name(), part, 1 + static_cast<int>(random() % kPieces));
          break;
        case 1:
          part.first = 1 + static_cast<int>(random() % (kPieces - 1));
          batch(name(), part, false);
          break;
        case 2:
          part.last = 1 + static_cast<int>(random() % kPieces);
          batch(name(), part, false);
          break;
        case 3:
          part.wrong = true;
          batch(name(), part, false);
          break;
        default:
          batch(name(), part, false);
      }
    }
    for (const unsigned recording : order) {
      ASSERT_EQ(batch(name(), {recording}, true), "") << "seed " << seed;
      ASSERT_EQ(batch(name(), {recording}, false), "") << "a replay";
    }
    const std::string expected = file.path("whole" + std::to_string(seed));
    for (const unsigned recording : order) ASSERT_EQ(batch(expected, {recording}, false), "");
    EXPECT_EQ(figures(path), figures(expected)) << "seed " << seed;
  }
}

TEST(LedgerMix, AMoreCompleteRunReplacesTheOther) {
  const LedgerFile file;
  killed(file.path(), {1}, 2);
  EXPECT_EQ(contentsOf(file.path()).totals.at(0)[0].tally.counted, 2U * kSamplesOfPiece);
  EXPECT_EQ(batch(file.path(), {1}, false), "");
  EXPECT_EQ(contentsOf(file.path()).totals.at(0)[0].tally.counted, 1U * kPieces * kSamplesOfPiece);
  EXPECT_NE(batch(file.path(), {1, 2}, false).find("has samples of run 1-0"), std::string::npos);
  EXPECT_NE(batch(file.path(), {1, 0, kPieces, true}, false).find("other sensor parameters"), std::string::npos);
  EXPECT_NE(batch(file.path(), {1, 2}, true).find("cannot replace"), std::string::npos);
}

TEST(LedgerMix, ARunIsTakenOut) {
  const LedgerFile file;
  for (const unsigned recording : {1U, 2U}) EXPECT_EQ(batch(file.path(), {recording}, false), "");
  EXPECT_NE(removeFromLedger(file.path(), "9-0").value_or("").find("has no run 9-0"), std::string::npos);
  EXPECT_EQ(removeFromLedger(file.path(), "1-0"), std::nullopt);
  EXPECT_EQ(batch(file.path("one"), {2}, false), "");
  EXPECT_EQ(figures(file.path()), figures(file.path("one")));
}

TEST(LedgerMix, ARunThatContradictsTheMachineGoes) {
  const LedgerFile file;
  EXPECT_EQ(batch(file.path(), {2}, false), "");
  const std::vector<std::string> before = figures(file.path());
  LedgerRun run(file.path(), machine(), idOf({1}));
  EXPECT_FALSE(run.add(piecesOf({1})[0]));
  EXPECT_NE(figures(file.path()), before) << "it counts";
  run.refuse("crank: turns backward");
  EXPECT_NE(run.end({}).value_or("").find("turns backward"), std::string::npos);
  EXPECT_EQ(figures(file.path()), before);
}

/// A run's bag is counted while the run is being written. Its content counts once, and the whole bag completes it.
TEST(LedgerMix, ARunWhoseBagIsCountedMeanwhileIsNotCountedTwice) {
  for (const int written : {1, 2}) {
    const LedgerFile file;
    LedgerRun live(file.path(), machine(), idOf({1}));
    const std::vector<LifePiece> pieces = piecesOf({1});
    for (int i = 0; i < written; ++i) EXPECT_EQ(live.add(pieces[static_cast<std::size_t>(i)]), kWritten);
    EXPECT_EQ(batch(file.path(), {1, 0, 3}, false), "");
    EXPECT_NE(live.add(pieces[3]).value_or("").find("not counted again"), std::string::npos);
    EXPECT_NE(live.end(pieces[4]).value_or("").find("not counted again"), std::string::npos);
    EXPECT_EQ(contentsOf(file.path()).totals.at(0)[0].tally.counted, 3U * kSamplesOfPiece);
    EXPECT_EQ(batch(file.path(), {1}, false), "");
    EXPECT_EQ(batch(file.path("whole"), {1}, false), "");
    EXPECT_EQ(figures(file.path()), figures(file.path("whole")));
  }
}

TEST(LedgerMix, ARunThatIsTakenOutAtWorkGoesOnAndItsBagCompletesIt) {
  const LedgerFile file;
  LedgerRun live(file.path(), machine(), idOf({1}));
  const std::vector<LifePiece> pieces = piecesOf({1});
  EXPECT_EQ(batch(file.path(), {2}, false), "");
  EXPECT_EQ(live.add(pieces[0]), kWritten);
  EXPECT_EQ(removeFromLedger(file.path(), idOf({1}).name), std::nullopt);
  for (std::size_t i = 1; i < pieces.size(); ++i) EXPECT_EQ(live.add(pieces[i]), kWritten);
  EXPECT_EQ(live.end({}), kWritten);
  EXPECT_EQ(contentsOf(file.path()).totals.at(0)[0].tally.counted, (2U * kPieces - 1U) * kSamplesOfPiece);
  EXPECT_EQ(batch(file.path(), {1}, false), "");
  for (const unsigned recording : {2U, 1U}) EXPECT_EQ(batch(file.path("whole"), {recording}, false), "");
  EXPECT_EQ(figures(file.path()), figures(file.path("whole")));
}

TEST(LedgerMix, AFileWithTwoNamesIsRefused) {
  const LedgerFile file;
  EXPECT_EQ(batch(file.path(), {1}, false), "");
  std::filesystem::create_hard_link(file.path(), file.path("other"));
  for (const std::string& name : {file.path(), file.path("other")})
    EXPECT_EQ(batch(name, {2}, false), name + ": has several names (hard links), must have one");
  std::filesystem::remove(file.path("other"));
  EXPECT_EQ(batch(file.path(), {2}, false), "");
}

}  // namespace
}  // namespace hammer_loads::life
