/// Test machine with two channels, its runs and a directory for its ledger.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_reader.h"
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/life/life_recorder.h"
#include "support/count_text.h"

namespace hammer_loads::life::test {

constexpr std::int64_t kSecond = 1000000000;
constexpr std::int64_t kDay = 86400 * kSecond;
constexpr std::int64_t kStart = 20000 * kDay + 7 * 3600 * kSecond;  ///< 2024-10-04, 7 h

using Problem = std::optional<std::string>;
inline const Problem kWritten;  ///< none

inline const std::vector<std::string> kInputs{"hull_wrench/force_z", "joint_loads/arm_joint/total_torque"};

inline LifeSettings settings(std::int64_t classes = 200) {
  LifeSettings s;
  s.channels = {{kInputs[0], LoadGrid::make(-1000.0, 1000.0, classes).value.value()},
                {"stress/toe",
                 LoadGrid::make(-100.0, 100.0, classes).value.value(),
                 "toe",
                 {{kInputs[1], 0.1}},
                 SnCurve::make(50.0, 1e6, 3.0, 5.0).value.value(),
                 FkmMeanStress{0.2}}};
  s.period = 60 * kSecond;
  s.equivalent_cycles_per_hour = 3600.0;
  return s;
}

inline LifeRecorder recorder(const LifeSettings& of = settings()) { return LifeRecorder(of, kInputs); }
inline LedgerMachine machine(const std::string& identity = "mo100", const LifeSettings& of = settings()) {
  return ledgerMachine(of, identity);
}

/// Generates loads at 10 Hz, identical for the same seed.
class Loads {
 public:
  explicit Loads(unsigned seed, std::int64_t start = kStart) : random_(seed), stamp_(start) {}
  void feed(LifeRecorder& to, int samples) {
    for (int i = 0; i < samples; ++i) {
      const double values[] = {load_(random_), load_(random_)}, deviations[] = {20.0, 10.0};
      to.sample(stamp_, values, deviations);
      stamp_ += kSecond / 10;
      if (i % 7 == 0) to.turn();
    }
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> load_{0.0, 250.0};
  std::int64_t stamp_;
};

class LedgerFile {
 public:
  LedgerFile() : directory_(testing::TempDir() + "ledger_" + std::to_string(getpid())) {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directory(directory_);
  }
  ~LedgerFile() { std::filesystem::remove_all(directory_); }
  std::string path(const std::string& name = "ledger.sqlite") const { return (directory_ / name).string(); }
  std::string bytes() const {
    std::ostringstream text;
    text << std::ifstream(path(), std::ios::binary).rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path directory_;
};

/// Another program that keeps a lock on the file for reading or writing.
class Holder {
 public:
  Holder(const std::string& path, const char* sql) : database_(path, Database::Use::kWrite, 0) {
    database_.run(sql);
    EXPECT_EQ(database_.problem(), "");
  }

 private:
  Database database_;
};

struct Contents {
  std::vector<LedgerEpoch> epochs;
  std::vector<std::vector<CycleCount>> totals;  ///< by epoch and channel
  std::string problem;
};

inline Contents contentsOf(const std::string& path) {
  Contents contents;
  LedgerReader reader(path);
  contents.epochs = reader.epochs();
  for (const LedgerEpoch& epoch : contents.epochs) {
    contents.totals.emplace_back();
    for (const CountedChannel& channel : epoch.machine.channels)
      contents.totals.back().push_back(reader.counts(epoch, channel).total);
  }
  contents.problem = reader.problem();
  return contents;
}

inline std::vector<std::string> statesOf(const std::vector<CycleCount>& counts) {
  std::vector<std::string> states;
  for (const CycleCount& count : counts) states.push_back(textOf(count));
  return states;
}

}  // namespace hammer_loads::life::test
