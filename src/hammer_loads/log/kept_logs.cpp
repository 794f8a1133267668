#include "hammer_loads/log/kept_logs.h"

#include <unistd.h>

#include <vector>

#include "hammer_loads/log/log_directory.h"

namespace hammer_loads {

void KeptLogs::findEarlierRuns(const std::string& directory, const LogSettings& settings) {
  const std::vector<FoundLog> found = findLogs(directory, filePrefix(settings));
  unclosed_size_ = 0;
  if (!settings.prune_earlier_runs) {
    for (const FoundLog& log : found) unclosed_size_ += log.is_unfinished ? log.size : 0;
    return;
  }
  closed_.clear();
  closed_size_ = 0;
  for (const FoundLog& log : found) add(log.path, log.size);
}

void KeptLogs::add(const std::string& path, std::uint64_t size) {
  closed_.push_back({path, size});
  closed_size_ += size;
}

std::uint64_t KeptLogs::makeRoom(const LogSettings& settings) {
  if (settings.total_size == 0) return 0;
  std::uint64_t deleted = 0;
  const std::uint64_t kept = unclosed_size_ + settings.split_size;
  while (!closed_.empty() && closed_size_ + kept > settings.total_size) {
    if (unlink(closed_.front().path.c_str()) == 0) ++deleted;
    closed_size_ -= closed_.front().size;
    closed_.pop_front();
  }
  return deleted;
}

}  // namespace hammer_loads
