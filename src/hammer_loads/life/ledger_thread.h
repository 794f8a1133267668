/// A ledger written by a thread of its own.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/life/piece_sink.h"

namespace hammer_loads::life {

/// Owns a thread that alone accesses the file; begin(), add(), refuse() and end() only keep what they get.
/// A piece that cannot be written is kept and tried again each second; runs are written in their order.
class LedgerThread final : public LiveLedger {
 public:
  explicit LedgerThread(std::string path);
  ~LedgerThread() override;
  LedgerThread(const LedgerThread&) = delete;
  LedgerThread& operator=(const LedgerThread&) = delete;

  void begin(const LedgerMachine& machine, const RunId& run) override;
  void add(const LifePiece& piece) override { give(piece, false); }
  void refuse(const std::string& reason) override;
  void end(const LifePiece& last) override { give(last, true); }
  /// The thread is then at its end.
  std::optional<std::string> close() override;
  State state() const override;
  const std::string& path() const override { return path_; }

 private:
  struct Run {
    LedgerRun ledger;  ///< the thread's own
    // Under the mutex.
    std::vector<LifePiece> given{};  ///< pieces that the thread has not taken, those of one day merged
    std::string refusal{};
    bool ends{};
  };

  void give(const LifePiece& piece, bool ends);
  void work();
  void write(std::unique_lock<std::mutex>& lock);

  const std::string path_;
  std::string refusal_;  ///< refusals of ended runs; kept, as their counts are in no ledger
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Run> runs_;  ///< runs that are not wholly written; this and the following members are under the mutex
  State state_;
  bool given_{}, closing_{};
  std::thread thread_;
};

}  // namespace hammer_loads::life
