/// A ledger written by a thread of its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/life/live_ledger.h"

namespace hammer_loads::life {

/// Owns a thread that alone accesses the file; begin(), add() and end() only queue jobs.
/// A piece that cannot be written is kept and tried again each second; runs are written in their order.
class LedgerThread final : public LiveLedger {
 public:
  explicit LedgerThread(std::string path);
  ~LedgerThread() override;
  LedgerThread(const LedgerThread&) = delete;
  LedgerThread& operator=(const LedgerThread&) = delete;

  void begin(const LedgerMachine& machine, const RunId& run) override;
  void add(const LifePiece& piece) override;
  void refuse(const std::string& reason) override;
  void end(const LifePiece& last) override;
  /// The thread is then at its end.
  std::optional<std::string> close() override;
  State state() const override;
  const std::string& path() const override { return path_; }

 private:
  struct Run {
    LedgerRun ledger;
    bool ends{};
  };
  using Job = std::function<void(std::deque<Run>&)>;
  struct Waiting {
    Job job;
    std::shared_ptr<LifePiece> piece;  ///< piece that the job adds; null: it does something else
  };

  void put(Job job, std::shared_ptr<LifePiece> piece = nullptr);
  void work();
  void write();

  const std::string path_;
  std::deque<Run> runs_;  ///< the thread's own
  std::string refusal_;   ///< refusals of ended runs; kept, as their counts are in no ledger
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Waiting> jobs_;  ///< jobs; this and the following members are under the mutex
  State state_;
  bool closing_{};
  std::thread thread_;
};

}  // namespace hammer_loads::life
