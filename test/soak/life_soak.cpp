// Runs a month of one channel through counter, revolution loads and ledger. Usage: life_soak DIRECTORY [SAMPLES]
// Default: 30 days at 1 kHz, 2592000000 samples, some 12 million revolutions.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <vector>

#include "hammer_loads/life/ledger_reader.h"
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/turn_loads.h"
#include "soak/verdict.h"
#include "support/resident_memory.h"

namespace hammer_loads::soak {
namespace {

constexpr std::uint64_t kMonth = 2592000000;
constexpr std::int64_t kMs = 1000000;
constexpr std::uint64_t kSamplesOfTurn = 216;
constexpr std::uint64_t kMemorySamples = 400;
const std::vector<std::string> kInputs{"hull_wrench/force_z"};

/// Returns pulses of random height per revolution with noise: 10 million values, repeated with another offset.
std::vector<double> loads() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> values;
  double height = 0.0;
  for (std::uint64_t i = 0; i < 10000000; ++i) {
    if (i % kSamplesOfTurn == 0) height = 40000.0 + 4000.0 * noise(random);
    const double phase = static_cast<double>(i % kSamplesOfTurn) / kSamplesOfTurn;
    values.push_back(height * std::pow(std::sin(3.14159265358979 * phase), 15) + 100.0 * noise(random));
  }
  return values;
}

int run(const std::string& directory, std::uint64_t samples) {
  life::LifeSettings settings;
  settings.channels = {{kInputs[0], life::LoadGrid::make(-200000.0, 200000.0, 4096).value.value()}};
  settings.period = 3600000 * kMs;
  settings.equivalent_cycles_per_hour = 3600.0;
  const std::string path = directory + "/ledger.sqlite";
  std::filesystem::remove(path);
  const std::vector<double> series = loads();
  life::LifeRecorder recorder(settings, kInputs);
  life::TurnLoadsRecorder turn_loads(kInputs.size());
  life::LedgerRun ledger(path, life::ledgerMachine(settings, "soak"), "run");

  Verdict verdict;
  test::MemoryRecord memory;
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t turns = 0, wrong_turns = 0, periods = 0, largest_residue = 0;
  double slowest_period = 0.0;
  const auto keep = [&] {
    const auto start = std::chrono::steady_clock::now();
    life::LifePiece piece = recorder.take();
    largest_residue = std::max<std::uint64_t>(largest_residue, piece.counts[0].residue.size());
    const auto trouble = ledger.add(std::move(piece));
    verdict.demand(!trouble, trouble.value_or(""));
    slowest_period =
        std::max(slowest_period, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    ++periods;
  };
  for (std::uint64_t i = 0, at = 0; i < samples; ++i, at = at + 1 == series.size() ? 0 : at + 1) {
    const std::int64_t stamp = static_cast<std::int64_t>(i) * kMs;
    if (recorder.due(stamp)) keep();
    recorder.sample(stamp, &series[at], nullptr);
    turn_loads.add(stamp, &series[at]);
    if (i % kSamplesOfTurn == kSamplesOfTurn - 1) {
      const life::ChannelTurn& turn = turn_loads.endTurn(stamp).channels[0];
      wrong_turns += !(turn.minimum.value <= turn.mean && turn.mean <= turn.maximum.value);
      recorder.turn();
      ++turns;
    }
    if (i % (samples / kMemorySamples) == 0) memory.add(test::residentMemory());
  }
  keep();
  const auto trouble = ledger.end({});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  verdict.tell("samples", static_cast<double>(samples));
  verdict.tell("turns", static_cast<double>(turns));
  verdict.tell("periods", static_cast<double>(periods));
  verdict.tell("seconds", seconds);
  verdict.tell("slowest_period_s", slowest_period);
  verdict.tell("largest_residue", static_cast<double>(largest_residue));
  verdict.tell("memory_first_quarter_MB", 1e-6 * memory.firstQuarter());
  verdict.tell("memory_last_quarter_MB", 1e-6 * memory.lastQuarter());
  verdict.tell("ledger_MB", 1e-6 * static_cast<double>(std::filesystem::file_size(path)));
  verdict.demand(!trouble, trouble.value_or(""));
  verdict.demand(wrong_turns == 0, "every turn's mean between its extremes");
  verdict.demand(std::abs(memory.growth()) <= 0.02, "memory of the last quarter within 2 % of the first");
  life::LedgerReader reader(path);
  const std::vector<life::LedgerEpoch> epochs = reader.epochs();
  const life::CycleCount total = reader.counts(epochs.at(0), epochs[0].machine.channels[0]).total;
  std::uint64_t blows = 0;
  for (const life::LedgerDay& day : epochs[0].days) blows += day.turns;
  verdict.tell("cells", static_cast<double>(total.closed.size()));
  verdict.demand(reader.problem().empty(), "the ledger is whole");
  verdict.demand(total.tally.counted == samples && blows == turns, "every sample and turn is in the ledger once");
  return verdict.exitCode();
}

}  // namespace
}  // namespace hammer_loads::soak

int main(int argc, char** argv) {
  const std::uint64_t samples = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : hammer_loads::soak::kMonth;
  if (argc < 2 || argc > 3 || samples < 1000000) {
    std::fprintf(stderr, "usage: life_soak DIRECTORY [SAMPLES], at least 1000000\n");
    return 2;
  }
  return hammer_loads::soak::run(argv[1], samples);
}
