// The command life on a ledger of the series of ASTM E1049-85, Fig. 6.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"
#include "settings/temporary_file.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

using test::linesOf;
using test::Outcome;

constexpr std::int64_t kSecond = 1000000000, kDay = 86400 * kSecond;

Outcome runLife(const std::string& arguments) { return test::runCommand(HAMMER_LOADS_LIFE, arguments); }

/// One run of the series at 1 Hz, 8 s, so that 450 cycles an hour are one cycle.
class Ledger {
 public:
  Ledger() : path_(testing::TempDir() + "life_" + std::to_string(getpid()) + ".sqlite") {
    remove();
    life::LifeSettings settings;
    settings.channels = {{"hull_wrench/force_z", life::LoadGrid::make(-10.5, 10.5, 21).value.value()},
                         {"stress/toe",
                          life::LoadGrid::make(-20.5, 20.5, 41).value.value(),
                          "toe",
                          {{"hull_wrench/force_z", 2.0}},
                          life::SnCurve::make(1000.0, 1e3, 5.0, 5.0).value.value()}};
    settings.period = 60 * kSecond;
    settings.equivalent_cycles_per_hour = 450.0;
    life::LifeRecorder recorder(settings, {"hull_wrench/force_z"});
    std::int64_t stamp = 20000 * kDay;
    for (const double value : {-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0}) {
      const double deviation = 0.01;
      recorder.sample(stamp, &value, &deviation);
      stamp += kSecond;
    }
    recorder.turn();
    recorder.turn();
    EXPECT_FALSE(life::LedgerRun(path_, life::ledgerMachine(settings, "MO-100, \"yellow\""), "a").end(recorder.take()));
  }
  ~Ledger() { remove(); }
  const std::string& path() const { return path_; }

 private:
  void remove() const {
    std::remove(path_.c_str());
    std::remove((path_ + ".lock").c_str());
  }
  std::string path_;
};

using Row = std::map<std::string, std::string>;

std::vector<Row> rowsOf(const std::string& csv) {
  std::vector<Row> rows;
  std::vector<std::string> titles;
  for (const std::string& line : linesOf(csv)) {
    std::vector<std::string> cells;
    std::istringstream stream(line + ",");
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (titles.empty()) {
      titles = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), titles.size()) << line;
    Row row;
    for (std::size_t i = 0; i < cells.size(); ++i) row[titles[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

// Sum of n r^5 of the series, half cycles as such; its cycles of two ranges each.
constexpr double kSum = 0.5 * (3 * 3 * 3 * 3 * 3) + 1.5 * (4 * 4 * 4 * 4 * 4) + 0.5 * (6 * 6 * 6 * 6 * 6) +
                        1.0 * (8 * 8 * 8 * 8 * 8) + 0.5 * (9 * 9 * 9 * 9 * 9);

TEST(Life, CsvHasTheFiguresOfTheStandardsExample) {
  const Ledger ledger;
  const Outcome outcome = runLife(ledger.path() + " --csv");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<Row> rows = rowsOf(outcome.out);
  ASSERT_EQ(rows.size(), 4U);  // two channels, each with a total and one day
  const Row& load = rows[0];
  EXPECT_EQ(load.at("channel"), "hull_wrench/force_z");
  EXPECT_EQ(load.at("unit"), "N");
  EXPECT_EQ(load.at("day"), "all");
  EXPECT_EQ(load.at("blows"), "2");
  EXPECT_EQ(load.at("cycles"), "4");
  EXPECT_EQ(load.at("largest_range"), "9");
  EXPECT_NEAR(std::stod(load.at("hours")), 8.0 / 3600.0, 1e-15);
  EXPECT_NEAR(std::stod(load.at("equivalent_range_3")), 10.3039982, 5e-8);
  EXPECT_NEAR(std::stod(load.at("equivalent_range_4")), 9.58741061, 5e-9);
  EXPECT_NEAR(std::stod(load.at("equivalent_range_5")), 9.25325663, 5e-9);
  EXPECT_NEAR(std::stod(load.at("equivalent_range_10")), 8.82000396, 5e-9);
  EXPECT_EQ(load.at("damage"), "");
  EXPECT_EQ(load.at("remaining_hours"), "");
  EXPECT_EQ(rows[1].at("day"), "2024-10-04");
  EXPECT_EQ(rows[1].at("cycles"), "1");  // closed cycles only
  const Row& stress = rows[2];
  EXPECT_EQ(stress.at("channel"), "stress/toe");
  EXPECT_EQ(stress.at("unit"), "MPa");
  const double damage = kSum * 32.0 / 1e15 / 1e3;
  EXPECT_NEAR(std::stod(stress.at("damage")) / damage, 1.0, 1e-14);
  EXPECT_NEAR(std::stod(stress.at("remaining_hours")) / (8.0 / 3600.0 / damage), 1.0, 1e-9);
  // all ranges larger by sqrt(2) times 0.02 MPa
  EXPECT_NEAR(std::stod(stress.at("equivalent_range_5_std")) / std::stod(stress.at("equivalent_range_5")),
              std::stod(stress.at("damage_std")) / damage / 5.0, 1e-12);
  EXPECT_GT(std::stod(stress.at("damage_std")), 0.0);
}

TEST(Life, TextNamesChannelsDaysAndTheRulesOfCounting) {
  const Ledger ledger;
  const Outcome outcome = runLife(ledger.path());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"epoch 1: machine MO-100", "residue as half cycles", "450 cycles an hour", "stress/toe",
                           "2024-10-04", "range m=10", "hours left"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << '\n' << outcome.out;
}

TEST(Life, AFileThatIsNoLedgerIsOneLineAndExitCode1) {
  const test::TemporaryFile text(std::string(3000, 'x'), ".sqlite"), empty({}, ".sqlite");
  for (const std::string& file :
       {text.path(), empty.path(), testing::TempDir(), std::string("/no/such/file"), std::string("/dev/null")}) {
    const Outcome outcome = runLife(file);
    EXPECT_EQ(outcome.exit_code, 1) << file;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
}

/// Values that no run can have written: the SQL that sets them and the text that the message must contain.
const std::pair<const char*, const char*> kDamage[] = {
    {"UPDATE epochs SET equivalent_cycles_per_hour = 0", "epochs: equivalent_cycles_per_hour 0.0"},
    {"UPDATE epochs SET equivalent_cycles_per_hour = 9e999", "epochs: equivalent_cycles_per_hour"},
    {"UPDATE epochs SET equivalent_cycles_per_hour = 'many'", "epochs: equivalent_cycles_per_hour 'many'"},
    {"UPDATE epochs SET machine = x'00'", "epochs: machine"},
    {"UPDATE channels SET greatest = 9e999", "no possible grid"},
    {"UPDATE runs SET messages = -1", "runs: messages -1"},
    {"UPDATE days SET duration_ns = -8", "days: duration_ns -8"},
    {"UPDATE days SET turns = -1", "days: turns -1"},
    {"UPDATE days SET turns = 9223372036854775807", "days: turns 9223372036854775807"},
    {"UPDATE days SET date = '9999-99-99'", "days: date '9999-99-99'"},
    {"UPDATE days SET date = 'now'", "days: date 'now'"},
    {"UPDATE tallies SET counted = 'abc'", "tallies: counted 'abc'"},
    {"UPDATE tallies SET gaps = 1.5", "tallies: gaps 1.5"},
    {"UPDATE tallies SET least = 'low'", "tallies: least 'low'"},
    {"UPDATE tallies SET greatest = 9e999", "tallies: greatest"},
    {"UPDATE cycles SET count = 9223372036854775807", "cycles: count 9223372036854775807"},
    {"UPDATE cycles SET count = -3", "cycles: count -3"},
    {"UPDATE cycles SET low = 21", "cycles: low 21"},
    {"UPDATE cycles SET steps = 4294967297", "cycles: steps 4294967297"},
    {"UPDATE residues SET class = 4294967301", "residues: class 4294967301"},
    {"UPDATE residues SET class = -1", "residues: class -1"},
    {"ALTER TABLE cycles RENAME TO c; CREATE VIEW cycles AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 "
     "FROM "
     "n) SELECT 1 AS channel, 1 AS day, 1 AS steps, i AS low, 1 AS count FROM n",
     "view cycles: must hold tables alone"},
    {"CREATE TRIGGER t AFTER UPDATE ON runs BEGIN DELETE FROM days; END", "trigger t: must hold tables alone"}};

TEST(Life, AnImpossibleLedgerIsOneLineHereAndWhereARunIsAdded) {
  for (const auto& [sql, words] : kDamage) {
    SCOPED_TRACE(sql);
    const Ledger ledger;
    life::Database database(ledger.path(), life::Database::Use::kRead, 0);
    database.run(sql);
    ASSERT_TRUE(database.good()) << database.problem();
    const Outcome outcome = runLife(ledger.path() + " --csv");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(ledger.path() + ": "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    life::LedgerRun run(ledger.path(), {}, "b");
    life::LifePiece piece;
    piece.turns = 1;
    EXPECT_TRUE(run.add(piece)) << "a writer refuses it";
  }
}

TEST(Life, WrongUsageIsOneLineAndExitCode2) {
  for (const char* arguments : {"", "a.sqlite b.sqlite", "a.sqlite --json --csv", "--xml a.sqlite"}) {
    const Outcome outcome = runLife(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  }
}

}  // namespace
}  // namespace hammer_loads
