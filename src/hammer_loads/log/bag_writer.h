/// Writer of bags of format 2.0. rosbag::Bag asks the system for the end of the file with each message, which takes
/// most of its time. Its destructor terminates the process if the disk is full.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/log/log_settings.h"

namespace hammer_loads {

/// Bag that is being written. If it is not closed, `rosbag reindex` recovers its chunks. Every function throws
/// std::system_error if the file cannot be written.
class BagWriter {
 public:
  static constexpr std::size_t kChunk = 768 * 1024;  ///< size of a chunk, as in rosbag [byte]

  struct Connection {
    std::string topic, type, md5sum, definition;
    bool latched{};
    std::string caller;  ///< publishing node; empty: not written to the bag
  };
  /// Returns the connection of a topic for messages of the type of `message`.
  template <typename Message>
  static Connection connectionOf(const std::string& topic, const Message& message, bool latched,
                                 const std::string& caller = {}) {
    using namespace ros::message_traits;
    return {topic, datatype(message), md5sum(message), definition(message), latched, caller};
  }

  /// chunk_size: a chunk is closed when it has this many bytes before compression.
  explicit BagWriter(const std::string& file, std::size_t chunk_size = kChunk,
                     LogCompression compression = LogCompression::kLz4);
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  ~BagWriter();

  /// Writes a message. latched: mark it as latched; rosbag play keeps such a message for late subscribers.
  template <typename Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message, bool latched = false) {
    const std::uint32_t size = ros::serialization::serializationLength(message);
    const auto known = numbers_.find(topic);
    const std::uint32_t connection =
        known != numbers_.end() ? known->second : addConnection(connectionOf(topic, message, latched));
    std::uint8_t* place = beginMessage(connection, time, size);
    ros::serialization::OStream stream(place, size);
    ros::serialization::serialize(stream, message);
    endMessage();
  }
  /// Adds a connection and returns its number for the function below. Each topic needs at least one.
  std::uint32_t addConnection(Connection connection);
  /// Writes a message that is already serialised.
  void write(std::uint32_t connection, const ros::Time& time, const std::uint8_t* bytes, std::uint32_t size) {
    std::memcpy(beginMessage(connection, time, size), bytes, size);
    endMessage();
  }
  /// Writes the open chunk, if it holds anything.
  void closeChunk();
  /// Writes the open chunk and the index and closes the file.
  void close();

  std::uint64_t size() const noexcept { return position_; }  ///< on disk, without the open chunk [byte]
  /// Returns the largest possible size after close() if no further message is written [byte].
  std::uint64_t sizeBound() const noexcept;

 private:
  struct ChunkInfo {
    std::uint64_t position{};
    ros::Time first, last;
    std::map<std::uint32_t, std::uint32_t> counts;  ///< messages by connection
  };
  using Places = std::vector<std::pair<ros::Time, std::uint32_t>>;  ///< times and places of messages in their chunk

  std::string recordOf(std::uint32_t connection) const;
  std::uint8_t* beginMessage(std::uint32_t connection, const ros::Time& time, std::uint32_t size);
  void endMessage();
  void writeBagHeader(std::uint64_t index_position);
  void writeBytes(const std::string& bytes);

  std::size_t chunk_size_;
  LogCompression compression_;
  int descriptor_;
  std::uint64_t position_{};  ///< end of the file [byte]
  std::vector<Connection> connections_;
  std::map<std::string, std::uint32_t> numbers_;  ///< numbers of the connections, by topic
  std::vector<ChunkInfo> chunks_;                 ///< the last one is being filled
  std::string chunk_, packed_;                    ///< data of the open chunk, before and after compression
  std::map<std::uint32_t, Places> index_;         ///< places in the open chunk, by connection
  std::uint64_t messages_{};                      ///< number of messages in the open chunk
  std::uint64_t index_size_{};                    ///< largest possible size of the file's index [byte]
};

}  // namespace hammer_loads
