/// Who writes a ledger: one at a time, by whatever name it knows the file.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

namespace hammer_loads::life {

/// On the file itself, by device and inode: links and relative names lead to the same lock. The kernel releases it
/// however a process ends.
class LedgerLock {
 public:
  /// Makes the file where there is none. Nothing after a problem; busy: another run has it.
  static std::unique_ptr<LedgerLock> take(const std::string& path, std::string& problem, bool& busy);
  /// A file that was made for the lock and is still empty goes. No database of the file may be open in this process.
  ~LedgerLock();
  LedgerLock(const LedgerLock&) = delete;
  LedgerLock& operator=(const LedgerLock&) = delete;

  /// Whether the name still leads to the file that is locked.
  bool isAt(const std::string& path) const;
  /// The one name under which a file with several is opened: SQLite finds what a broken commit left by the name.
  const std::string& name() const { return name_; }

 private:
  LedgerLock(int file, std::string name, bool made, dev_t device, ino_t inode);
  int file_;
  std::string name_;
  bool made_;
  dev_t device_;
  ino_t inode_;
};

}  // namespace hammer_loads::life
