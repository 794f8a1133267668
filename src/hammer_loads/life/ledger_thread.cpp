#include "hammer_loads/life/ledger_thread.h"

#include <chrono>
#include <utility>

namespace hammer_loads::life {
namespace {

constexpr auto kRetry = std::chrono::seconds(1);

}  // namespace

LedgerThread::LedgerThread(std::string path) : path_(std::move(path)), thread_([this] { work(); }) {}

LedgerThread::~LedgerThread() { close(); }

std::optional<std::string> LedgerThread::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  if (state_.problem.empty()) return std::nullopt;
  return state_.problem;
}

void LedgerThread::begin(const LedgerMachine& machine, const RunId& run) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    runs_.push_back({LedgerRun(path_, machine, run)});
    given_ = true;
  }
  wake_.notify_one();
}

void LedgerThread::refuse(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  runs_.back().refusal = reason;
}

void LedgerThread::give(const LifePiece& piece, bool ends) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Run& run = runs_.back();
    run.given.push_back(piece);
    mergeDays(run.given);  // a blocked disk does not increase memory
    run.ends = ends;
    given_ = true;
  }
  wake_.notify_one();
}

LedgerThread::State LedgerThread::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void LedgerThread::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (bool closing = false; !closing;) {
    const auto called = [this] { return closing_ || given_; };
    if (state_.problem.empty()) {
      wake_.wait(lock, called);
    } else {
      wake_.wait_for(lock, kRetry, called);
    }
    closing = closing_;
    given_ = false;
    write(lock);
  }
}

/// Writes run after run until one is at work or has a problem. Others may give pieces meanwhile.
void LedgerThread::write(std::unique_lock<std::mutex>& lock) {
  std::optional<std::string> problem;
  while (!runs_.empty()) {
    Run& run = runs_.front();  // stays where it is, whatever is added behind
    const bool ends = run.ends;
    const std::vector<LifePiece> pieces = std::exchange(run.given, {});
    if (!run.refusal.empty()) run.ledger.refuse(run.refusal);
    lock.unlock();
    for (const LifePiece& piece : pieces) run.ledger.keep(piece);
    const std::string trouble = ledgerProblem(path_);
    problem = !trouble.empty() ? std::make_optional(trouble) : ends ? run.ledger.end({}) : run.ledger.add();
    lock.lock();
    const bool refused = trouble.empty() && run.ledger.refused();
    if (!ends || (problem && !refused)) break;
    if (refused) refusal_ = *std::exchange(problem, std::nullopt);
    runs_.pop_front();
  }
  state_ = {problem.value_or(refusal_), 0};
  for (const Run& run : runs_) state_.waiting += run.ledger.waiting() + run.given.size();
}

}  // namespace hammer_loads::life

extern "C" hammer_loads::life::LiveLedger* hammerLoadsMakeLedger(const std::string& path) {
  return new hammer_loads::life::LedgerThread(path);
}
