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

void LedgerThread::put(Job job) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!closing_) jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
}

void LedgerThread::begin(const LedgerMachine& machine, const RunId& run) {
  put({LedgerRun(path_, machine, run), {}, false});
}

void LedgerThread::add(const LifePiece& piece) { put({{}, piece, false}); }

void LedgerThread::refuse(const std::string& reason) { put({{}, {}, false, reason}); }

void LedgerThread::end(const LifePiece& last) { put({{}, last, true}); }

LedgerThread::State LedgerThread::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void LedgerThread::work() {
  for (bool closing = false; !closing;) {
    std::vector<Job> jobs;
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
    for (Job& job : jobs) take(std::move(job));
    write();
  }
}

void LedgerThread::take(Job job) {
  if (job.begin) runs_.push_back({*std::move(job.begin), false});
  if (!job.refusal.empty()) runs_.back().ledger.refuse(job.refusal);
  if (job.piece) runs_.back().ledger.keep(*std::move(job.piece));
  runs_.back().ends = runs_.back().ends || job.ends;
}

void LedgerThread::write() {
  std::optional<std::string> problem;
  while (!runs_.empty() && !problem) {
    Run& first = runs_.front();
    problem = first.ledger.prepare();
    if (!problem) problem = first.ends ? first.ledger.end({}) : first.ledger.add({});
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
