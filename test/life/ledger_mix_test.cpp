// Any mix of broken runs, replays, corrections, parts and names: the ledger of the whole recordings, each once.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_batch.h"
#include "life/ledger_support.h"

namespace hammer_loads::life {
namespace {

using namespace test;

constexpr int kPieces = 5, kSamplesOfPiece = 120;

/// A part of a recording in pieces, as a node or process_bag would count it; `wrong`: with other sensor parameters.
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

/// process_bag. What it says in one line; empty: counted, or in it already.
std::string batch(const std::string& path, const Part& part, bool replace) {
  LedgerBatch ledger(
      path, [](const std::string& line) { ADD_FAILURE() << line; }, replace);
  ledger.begin(machine(), idOf(part));
  for (const LifePiece& piece : piecesOf(part)) ledger.add(piece);
  std::vector<std::string> known;
  std::string problem = ledger.write(known);
  return problem.empty() ? ledger.commit() : problem;
}

/// A live node that is killed after some pieces.
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
    const std::string path = file.path("mix" + std::to_string(seed)), link = file.path("link" + std::to_string(seed));
    const std::string soft = file.path("soft" + std::to_string(seed));
    std::filesystem::create_symlink(path, soft);
    std::vector<unsigned> order;
    const auto name = [&]() -> std::string {
      if (!std::filesystem::exists(path)) return path;
      if (!std::filesystem::exists(link)) std::filesystem::create_hard_link(path, link);
      return random() % 3 == 0 ? link : random() % 2 == 0 ? soft : path;
    };
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

TEST(LedgerMix, WhatIsMoreCompleteTakesThePlaceByItself) {
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

/// As version 1 left it: no run apart, residues of what ended and of the run at work.
void makeVersion1(const std::string& path) {
  EXPECT_EQ(batch(path, {1}, false), "");
  Database old(path, Database::Use::kWrite, 0);
  old.run(R"(
DROP INDEX days_of_run; DROP TABLE marks;
CREATE TABLE old_tallies(
  channel INTEGER NOT NULL REFERENCES channels, day INTEGER NOT NULL REFERENCES days,
  counted INTEGER NOT NULL, skipped INTEGER NOT NULL, below INTEGER NOT NULL, above INTEGER NOT NULL,
  gaps INTEGER NOT NULL, deviations INTEGER NOT NULL, deviation_sum INTEGER NOT NULL, least REAL, greatest REAL,
  PRIMARY KEY(channel, day)) WITHOUT ROWID;
INSERT INTO old_tallies SELECT channel, day, counted, skipped, below, above, gaps, deviations, deviation_sum, least,
  greatest FROM tallies;
DROP TABLE tallies; ALTER TABLE old_tallies RENAME TO tallies;
CREATE TABLE old_residues(
  channel INTEGER NOT NULL REFERENCES channels, open INTEGER NOT NULL, place INTEGER NOT NULL, class INTEGER NOT NULL,
  PRIMARY KEY(channel, open, place)) WITHOUT ROWID;
INSERT INTO old_residues SELECT channel, 0, place, class FROM residues;
DROP TABLE residues; ALTER TABLE old_residues RENAME TO residues;
CREATE TABLE old_days(
  day INTEGER PRIMARY KEY, epoch INTEGER NOT NULL REFERENCES epochs, date TEXT NOT NULL,
  duration_ns INTEGER NOT NULL, turns INTEGER NOT NULL);
INSERT INTO old_days SELECT day, epoch, date, duration_ns, turns FROM days;
DROP TABLE days; ALTER TABLE old_days RENAME TO days;
CREATE TABLE old_runs(
  run INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, epoch INTEGER NOT NULL REFERENCES epochs,
  pieces INTEGER NOT NULL, ended INTEGER NOT NULL);
INSERT INTO old_runs SELECT run, name, epoch, pieces, ended FROM runs;
DROP TABLE runs; ALTER TABLE old_runs RENAME TO runs;
PRAGMA user_version = 1;)");
  EXPECT_EQ(old.problem(), "");
}

TEST(LedgerMix, ALedgerOfVersion1GoesOn) {
  const LedgerFile file;
  for (const unsigned recording : {1U, 2U}) EXPECT_EQ(batch(file.path("new"), {recording}, false), "");
  EXPECT_EQ(batch(file.path("first"), {1}, false), "");
  makeVersion1(file.path());
  EXPECT_EQ(figures(file.path()), figures(file.path("first"))) << "read as it is";
  EXPECT_EQ(batch(file.path(), {1}, false), "") << "not counted again";
  EXPECT_EQ(batch(file.path(), {2}, false), "");
  EXPECT_EQ(figures(file.path()), figures(file.path("new")));
  EXPECT_NE(removeFromLedger(file.path(), "1-0").value_or("").find("cannot be taken out"), std::string::npos);
}

}  // namespace
}  // namespace hammer_loads::life
