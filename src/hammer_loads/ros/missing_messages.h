/// Number of lost messages of an input.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace hammer_loads {

/// Gaps in header.seq, which each publisher counts up by itself: what a full queue on either side or a connection has
/// dropped. roscpp does not say how many its own queue drops.
class MissingMessages {
 public:
  void take(const std::string& publisher, std::uint32_t sequence) {
    if (last_.size() > kMostPublishers) last_.clear();  // restarted again and again under new names
    const auto [known, is_new] = last_.try_emplace(publisher, sequence);
    if (!is_new && sequence > known->second) count_ += sequence - known->second - 1;
    known->second = sequence;  // a lower one is of a publisher that restarted
  }
  std::uint64_t count() const { return count_; }

 private:
  static constexpr std::size_t kMostPublishers = 100;
  std::map<std::string, std::uint32_t> last_;
  std::uint64_t count_{};
};

}  // namespace hammer_loads
