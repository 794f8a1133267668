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

void LedgerThread::put(Job job, std::shared_ptr<LifePiece> piece) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closing_) return;
    // Waiting pieces of one day are merged, so that a blocked disk does not increase memory.
    const bool goes_on =
        piece && !jobs_.empty() && jobs_.back().piece && dayOf(jobs_.back().piece->stamp) == dayOf(piece->stamp);
    if (goes_on)
      jobs_.back().piece->advance(*piece);
    else
      jobs_.push_back({std::move(job), std::move(piece)});
  }
  wake_.notify_one();
}

void LedgerThread::begin(const LedgerMachine& machine, const RunId& run) {
  put([path = path_, machine, run](std::deque<Run>& runs) { runs.push_back({LedgerRun(path, machine, run), false}); });
}

void LedgerThread::add(const LifePiece& piece) {
  const auto kept = std::make_shared<LifePiece>(piece);
  put([kept](std::deque<Run>& runs) { runs.back().ledger.keep(*kept); }, kept);
}

void LedgerThread::refuse(const std::string& reason) {
  put([reason](std::deque<Run>& runs) { runs.back().ledger.refuse(reason); });
}

void LedgerThread::end(const LifePiece& last) {
  put([last](std::deque<Run>& runs) {
    runs.back().ledger.keep(last);
    runs.back().ends = true;
  });
}

LedgerThread::State LedgerThread::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void LedgerThread::work() {
  for (bool closing = false; !closing;) {
    std::vector<Waiting> jobs;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const auto called = [this] { return closing_ || !jobs_.empty(); };
      if (state_.problem.empty()) {
        wake_.wait(lock, called);
      } else {
        wake_.wait_for(lock, kRetry, called);
      }
      jobs.swap(jobs_);
      closing = closing_;
    }
    for (const Waiting& waiting : jobs) waiting.job(runs_);
    write();
  }
}

void LedgerThread::write() {
  std::optional<std::string> problem;
  while (!runs_.empty() && !problem) {
    Run& first = runs_.front();
    if (std::string trouble = ledgerProblem(path_); !trouble.empty()) {
      problem = std::move(trouble);
      break;
    }
    problem = first.ends ? first.ledger.end({}) : first.ledger.add();
    const bool refused = first.ledger.refused();
    if (!first.ends || (problem && !refused)) break;
    if (refused) refusal_ = *std::exchange(problem, std::nullopt);
    runs_.pop_front();
  }
  State state{problem.value_or(refusal_), 0};
  for (const Run& run : runs_) state.waiting += run.ledger.waiting();
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = std::move(state);
}

}  // namespace hammer_loads::life

extern "C" hammer_loads::life::LiveLedger* hammerLoadsMakeLedger(const std::string& path) {
  return new hammer_loads::life::LedgerThread(path);
}
