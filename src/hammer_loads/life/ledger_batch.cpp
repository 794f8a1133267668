#include "hammer_loads/life/ledger_batch.h"

#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {
namespace {

constexpr int kBatchPatience = 60000;  // [ms]; others hold the ledger for a transaction

}  // namespace

std::string LedgerBatch::check() const { return ledgerProblem(path_, kBatchPatience); }

std::string LedgerBatch::write(std::vector<std::string>& known) {
  for (const LedgerRun& run : runs_)  // before a ledger is made
    if (const std::string refusal = run.contradiction(); !refusal.empty()) return path_ + ": " + refusal;
  if (std::string problem = check(); !problem.empty()) return problem;
  database_.emplace(path_, Database::Use::kWrite, kBatchPatience);
  beginAsLedger(*database_);
  checkLedger(*database_);
  std::string refused;
  for (LedgerRun& run : runs_) {
    if (run.putWhole(*database_, replace_)) continue;
    if (run.known()) known.push_back(path_ + ": " + run.refusal());
    if (!run.known() && refused.empty()) refused = path_ + ": " + run.refusal();
  }
  runs_.clear();
  return database_->good() ? refused : path_ + ": " + database_->problem();
}

std::string LedgerBatch::commit() {
  if (!database_) return {};
  database_->run("COMMIT");
  const std::string problem = database_->good() ? "" : path_ + ": " + database_->problem();
  database_.reset();
  return problem;
}

}  // namespace hammer_loads::life
