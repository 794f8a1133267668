#include "hammer_loads/life/ledger_batch.h"

#include <chrono>
#include <thread>
#include <utility>

#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {

LedgerBatch::LedgerBatch(std::string path, std::function<void(const std::string&)> busy, bool replace)
    : path_(std::move(path)), busy_(std::move(busy)), replace_(replace), gate_(path_, {}, "") {}

/// The database before the lock: a lock that is let go must find no open one.
LedgerBatch::~LedgerBatch() { database_.reset(); }

void LedgerBatch::begin(const LedgerMachine& machine, const RunId& run) { runs_.emplace_back(path_, machine, run); }

void LedgerBatch::add(const LifePiece& piece) { runs_.back().keep(piece); }

void LedgerBatch::refuse(const std::string& reason) { runs_.back().refuse(reason); }

void LedgerBatch::end(const LifePiece& last) { runs_.back().keep(last); }

/// A ledger is free within a transaction or after months: how long is the user's to judge.
std::string LedgerBatch::wait() {
  std::optional<std::string> problem = gate_.prepare();
  if (problem && gate_.isBusy()) busy_(*problem);
  for (; problem && gate_.isBusy(); problem = gate_.prepare())
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  return problem.value_or("");
}

std::string LedgerBatch::check() {
  std::string problem = wait();
  gate_ = LedgerRun(path_, {}, "");  // lets go of the ledger
  return problem;
}

std::string LedgerBatch::write(std::vector<std::string>& known) {
  if (std::string problem = wait(); !problem.empty()) return problem;
  database_ = std::make_unique<Database>(gate_.lockedName(), Database::Use::kWrite, LedgerRun::kPatience);
  beginAsLedger(*database_);
  std::string refused;
  for (LedgerRun& run : runs_) {
    if (run.putWhole(*database_, replace_)) continue;
    if (run.known()) known.push_back(path_ + ": " + run.refusal());
    if (!run.known() && refused.empty()) refused = path_ + ": " + run.refusal();
  }
  runs_.clear();
  if (!database_->good()) return path_ + ": " + database_->problem();
  return refused;
}

std::string LedgerBatch::commit() {
  if (!database_) return {};
  database_->run("COMMIT");
  const std::string problem = database_->good() ? "" : path_ + ": " + database_->problem();
  database_.reset();
  gate_ = LedgerRun(path_, {}, "");
  return problem;
}

}  // namespace hammer_loads::life
