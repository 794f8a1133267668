/// Messages of one or more bags, one after another in the order of their record times.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hammer_loads/ros/bag_file.h"

namespace hammer_loads {

/// Filter of the wanted connections.
using BagQuery = std::function<bool(const BagConnection&)>;
/// Filter of the chunks that may contain wanted messages, by their times. Empty: all.
using ChunkQuery = std::function<bool(const BagChunk&)>;

/// Holds in memory only the chunks whose times overlap at the present place. Messages of equal times are in the order
/// of the bags, then of the file.
class BagMessages {
 public:
  /// The bags must outlive it and are not read by others meanwhile.
  BagMessages(const std::vector<std::unique_ptr<BagFile>>& bags, const BagQuery& query, const ChunkQuery& chunks = {});

  /// Valid until the next call; null after the last one. Throws std::runtime_error where a bag is damaged.
  const BagMessage* next();
  /// Messages in all chunks that are wanted.
  std::uint64_t size() const { return size_; }

 private:
  struct Source {
    BagFile* bag;
    std::map<std::uint32_t, const BagConnection*> wanted;
  };
  struct Place {
    const BagChunk* chunk;
    std::size_t source;
  };
  struct OpenChunk {
    std::size_t place;  ///< in places_
    std::size_t at;     ///< in read.messages
    ReadChunk read;
    const BagMessage& message() const { return read.messages[at]; }
  };
  static bool isLater(const std::unique_ptr<OpenChunk>& a, const std::unique_ptr<OpenChunk>& b);
  void open(std::size_t place);
  void passMessage();

  std::vector<Source> sources_;
  std::vector<Place> places_;                      ///< chunks with wanted messages, by their first time
  std::size_t next_place_{};                       ///< place of the next chunk to be opened
  std::vector<std::unique_ptr<OpenChunk>> open_;   ///< a heap: the earliest message is the first one's
  std::vector<std::unique_ptr<OpenChunk>> spare_;  ///< memory to be used again
  bool given_{};                                   ///< the first one's message was given to the caller
  std::uint64_t size_{};
};

}  // namespace hammer_loads
