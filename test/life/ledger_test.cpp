// The ledger of a machine: its runs sum to one count of all of them, each once and on its days.
#include "life/ledger_support.h"

namespace hammer_loads::life {
namespace {

using namespace test;

TEST(Ledger, RunsInAnyPiecesAreTheCountOfAllTheirLoads) {
  const LedgerFile file;
  LifeRecorder whole = recorder();
  std::mt19937 random(1);
  for (unsigned run = 0; run < 5; ++run) {
    LifeRecorder part = recorder();
    Loads loads(run), same(run);
    LedgerRun ledger(file.path(), machine(), "run " + std::to_string(run));
    for (int piece = 0; piece < 6; ++piece) {
      const int samples = static_cast<int>(random() % 200);
      loads.feed(part, samples);
      same.feed(whole, samples);
      EXPECT_EQ(ledger.add(part.take()), kWritten);
    }
    if (run % 2 == 0) {
      EXPECT_EQ(ledger.end(part.take()), kWritten);
    }  // otherwise the next run ends it
    whole.gap();
    const Contents contents = contentsOf(file.path());
    EXPECT_EQ(contents.problem, "");
    EXPECT_EQ(contents.epochs.at(0).runs, run + 1U);
  }
  LifePiece expected = whole.take();
  for (CycleCount& count : expected.counts) count.tally.gaps = 0;
  const Contents contents = contentsOf(file.path());
  ASSERT_EQ(contents.epochs.size(), 1U);
  EXPECT_EQ(statesOf(contents.totals[0]), statesOf(expected.counts));
  EXPECT_EQ(contents.epochs[0].days.size(), 1U);
  EXPECT_EQ(contents.epochs[0].days[0].date, "2024-10-04");
  EXPECT_EQ(contents.epochs[0].days[0].turns, expected.turns);
  EXPECT_EQ(contents.epochs[0].machine.channels[1].curve->slopeBelow(), 5.0);
}

TEST(Ledger, ARunIsCountedOnce) {
  const LedgerFile file;
  for (const bool ended : {true, false}) {
    const std::string name = ended ? "a" : "b";
    LifeRecorder part = recorder();
    Loads(1).feed(part, 500);
    const LifePiece piece = part.take();
    {
      LedgerRun first(file.path(), machine(), name);
      EXPECT_EQ(ended ? first.end(piece) : first.add(piece), kWritten);
      if (ended) {
        EXPECT_EQ(first.end({}), kWritten);
        EXPECT_EQ(first.add(piece), kWritten);  // nothing is added after the end
      }
    }
    const std::vector<std::string> once = statesOf(contentsOf(file.path()).totals.at(0));
    LedgerRun again(file.path(), machine(), name);
    EXPECT_EQ(again.add(piece), file.path() + ": run " + name + ": is in it already, not counted again");
    EXPECT_TRUE(again.refused());
    EXPECT_TRUE(again.end(piece));
    EXPECT_EQ(again.waiting(), 0U);
    EXPECT_EQ(statesOf(contentsOf(file.path()).totals.at(0)), once);
  }
}

TEST(Ledger, TheSameInputGivesTheSameBytes) {
  std::string bytes[2];
  for (std::string& one : bytes) {
    const LedgerFile file;
    for (unsigned run = 0; run < 3; ++run) {
      LifeRecorder part = recorder();
      Loads loads(run);
      LedgerRun ledger(file.path(), machine(), std::to_string(run));
      for (int piece = 0; piece < 4; ++piece) {
        loads.feed(part, 300);
        EXPECT_EQ(ledger.add(part.take()), kWritten);
      }
      EXPECT_EQ(ledger.end({}), kWritten);
    }
    one = file.bytes();
    EXPECT_EQ(one.find(testing::TempDir()), std::string::npos);
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(Ledger, AnotherMachineOrGridBeginsAnEpoch) {
  const LedgerFile file;
  const auto run = [&](const std::string& name, const LedgerMachine& of, const LifeSettings& with) {
    LifeRecorder part = recorder(with);
    Loads(7).feed(part, 300);
    EXPECT_EQ(LedgerRun(file.path(), of, name).end(part.take()), kWritten);
  };
  LifeSettings finer = settings(300), steeper = settings();
  steeper.channels[1].curve = SnCurve::make(50.0, 1e6, 4.0, 5.0).value.value();
  steeper.equivalent_cycles_per_hour = 60.0;
  run("1", machine("a"), settings());
  run("2", machine("a", steeper), steeper);  // other judgement of the same counts
  run("3", machine("b"), settings());
  run("4", machine("b", finer), finer);
  run("5", machine("a"), settings());  // back again: not mixed with the first, as the boom carried another in between
  const Contents contents = contentsOf(file.path());
  ASSERT_EQ(contents.epochs.size(), 4U);
  EXPECT_EQ(contents.epochs[0].runs, 2U);
  EXPECT_EQ(contents.epochs[0].machine.channels[1].curve->slope(), 4.0);
  EXPECT_EQ(contents.epochs[0].machine.equivalent_cycles_per_hour, 60.0);
  EXPECT_EQ(contents.epochs[2].machine.channels[0].grid.classes(), 300U);
  EXPECT_EQ(statesOf(contents.totals[1]), statesOf(contents.totals[3]));
  EXPECT_NE(statesOf(contents.totals[0]), statesOf(contents.totals[1]));
}

TEST(Ledger, AClockThatRunsBackReordersNothing) {
  const LedgerFile file;
  LifeRecorder whole = recorder();
  const std::int64_t starts[] = {kStart, kStart + kDay, 0, kStart + kDay, kStart - 40 * kDay};
  for (std::size_t run = 0; run < 5; ++run) {
    LifeRecorder part = recorder();
    Loads(static_cast<unsigned>(run), starts[run]).feed(part, 400);
    Loads(static_cast<unsigned>(run), starts[run]).feed(whole, 400);
    EXPECT_EQ(LedgerRun(file.path(), machine(), std::to_string(run)).end(part.take()), kWritten);
  }
  const Contents contents = contentsOf(file.path());
  std::vector<std::string> dates;
  for (const LedgerDay& day : contents.epochs.at(0).days) dates.push_back(day.date);
  EXPECT_EQ(dates, (std::vector<std::string>{"2024-10-04", "2024-10-05", "1970-01-01", "2024-10-05", "2024-08-25"}));
  EXPECT_EQ(statesOf(contents.totals[0]), statesOf(whole.take().counts));
}

/// Returns the days of three runs across midnights, cut as a node with this period cuts them.
std::vector<std::string> daysWithPeriod(std::int64_t period) {
  const LedgerFile file;
  LifeSettings s = settings();
  s.period = period;
  for (unsigned run = 0; run < 3; ++run) {
    std::mt19937 random(run);
    std::normal_distribution<double> load(0.0, 250.0);
    LifeRecorder part = recorder(s);
    LedgerRun ledger(file.path(), machine("mo100", s), std::to_string(run));
    for (std::int64_t stamp = 20001 * kDay - 200 * kSecond + run * kDay; stamp < (20001 + run) * kDay + 99 * kSecond;
         stamp += kSecond / 20) {
      if (part.due(stamp)) {
        EXPECT_EQ(ledger.add(part.take()), kWritten);
      }
      const double values[] = {load(random), load(random)}, deviations[] = {load(random) * load(random), 1.0};
      part.sample(stamp, values, deviations);
    }
    EXPECT_EQ(ledger.end(part.take()), kWritten);
  }
  LedgerReader reader(file.path());
  const LedgerEpoch epoch = reader.epochs().at(0);
  std::vector<std::string> days;
  for (const LedgerDay& day : epoch.days) days.push_back(day.date + " " + std::to_string(day.duration));
  for (const CountedChannel& channel : epoch.machine.channels) {
    const LedgerCounts counts = reader.counts(epoch, channel);
    for (const CycleCount& count : counts.days) days.push_back(textOf(count));
    days.push_back(textOf(counts.total));
  }
  return days;
}

TEST(Ledger, ThePeriodChangesNoNumberOfAnyDay) {
  const std::vector<std::string> fine = daysWithPeriod(17 * kSecond), coarse = daysWithPeriod(100000 * kSecond);
  EXPECT_EQ(fine.size(), 4U * 3U + 2U);
  EXPECT_EQ(fine, coarse);
}

TEST(Ledger, MidnightAmongWaitingPiecesStays) {
  const LedgerFile file;
  LifeRecorder part = recorder();
  LedgerRun run(file.path(), machine(), "a");
  for (int day = 0; day < 3; ++day) {
    for (int half = 0; half < 2; ++half) {
      Loads(7, kStart + day * kDay + half * 3600 * kSecond).feed(part, 100);
      run.keep(part.take());
    }
  }
  EXPECT_EQ(run.waiting(), 3U);
  EXPECT_EQ(run.end({}), kWritten);
  const Contents contents = contentsOf(file.path());
  ASSERT_EQ(contents.epochs.at(0).days.size(), 3U);
  EXPECT_EQ(contents.epochs[0].days[2].date, "2024-10-06");
  EXPECT_EQ(contents.epochs[0].days[2].turns, 30U);
}

}  // namespace
}  // namespace hammer_loads::life
