#include "hammer_loads/life/ledger_batch.h"

#include <chrono>
#include <thread>
#include <utility>

namespace hammer_loads::life {

LedgerBatch::LedgerBatch(std::string path, std::function<void(const std::string&)> busy)
    : path_(std::move(path)), busy_(std::move(busy)) {}

void LedgerBatch::begin(const LedgerMachine& machine, const std::string& run) {
  runs_.emplace_back(path_, machine, run);
}

void LedgerBatch::add(const LifePiece& piece) { runs_.back().keep(piece); }

void LedgerBatch::end(const LifePiece& last) { runs_.back().keep(last); }

/// A ledger is free within a transaction or after months: how long is the user's to judge.
std::optional<std::string> LedgerBatch::waitFor(LedgerRun& run) {
  std::optional<std::string> problem = run.prepare();
  if (problem && run.isBusy()) busy_(*problem);
  for (; problem && run.isBusy(); problem = run.prepare()) std::this_thread::sleep_for(std::chrono::milliseconds(200));
  return problem;
}

std::string LedgerBatch::check() {
  LedgerRun probe(path_, {}, "");
  return waitFor(probe).value_or("");
}

std::string LedgerBatch::write(std::vector<std::string>& known) {
  for (LedgerRun& run : runs_) {
    std::optional<std::string> problem = waitFor(run);
    if (!problem) problem = run.end({});
    if (problem && !run.refused()) return *problem;
    if (problem) known.push_back(*problem);
    run = LedgerRun(path_, {}, "");  // lets go of the ledger
  }
  runs_.clear();
  return {};
}

}  // namespace hammer_loads::life
