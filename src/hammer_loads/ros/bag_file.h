/// Reader of a recorded bag, chunk by chunk. Unlike rosbag::Bag it keeps no index of every message, so that its memory
/// does not grow with the recording. Format: wiki.ros.org/Bags/Format/2.0.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>
#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hammer_loads {

/// Messages of one publisher on one topic.
struct BagConnection {
  std::string topic, type, md5sum;
  std::string publisher;  ///< name of the node; empty where the bag does not state it
};

/// A message within a chunk in memory.
struct BagMessage {
  ros::Time time;  ///< time of its record
  const BagConnection* connection;
  const std::uint8_t* data;
  std::uint32_t size;

  template <typename Message>
  bool is() const {
    const std::string& md5sum = connection->md5sum;
    return md5sum == "*" || md5sum == ros::message_traits::md5sum<Message>();
  }
  /// Deserialises into a message, which may be reused. Throws std::runtime_error for a damaged message or another
  /// definition.
  template <typename Message>
  void to(Message& message) const {
    if (!is<Message>())
      throw std::runtime_error("a message on " + connection->topic + " cannot be read: of another definition");
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(data), size);  // which only reads
    ros::serialization::deserialize(stream, message);
  }
};

/// Position, times and content of a chunk, from the index at the bag's end.
struct BagChunk {
  std::uint64_t position{};                       ///< in the file
  ros::Time first, last;                          ///< record times of its messages
  std::map<std::uint32_t, std::uint32_t> counts;  ///< messages by connection
};

/// The messages of one chunk.
struct ReadChunk {
  std::vector<std::uint8_t> packed, bytes;
  std::vector<BagMessage> messages;
};

class BagFile {
 public:
  /// Throws rosbag::BagUnindexedException for a recording that was not closed, std::runtime_error for a file that is no
  /// bag.
  explicit BagFile(const std::string& file);
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;
  ~BagFile();

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  const std::vector<BagChunk>& chunks() const { return chunks_; }
  /// Messages of the chunk on these connections, in the order of their record times, equal ones in that of the file.
  /// `read` keeps its memory from chunk to chunk. Throws std::runtime_error where the chunk is damaged.
  void read(const BagChunk& chunk, const std::map<std::uint32_t, const BagConnection*>& wanted, ReadChunk& read);

 private:
  std::string bytesAt(std::uint64_t position, std::uint64_t size) const;
  void readInto(std::uint64_t position, std::uint8_t* to, std::size_t size) const;
  void readIndex(std::uint64_t position, std::uint32_t connections, std::uint32_t chunks);
  void unpack(rosbag::CompressionType packing, ReadChunk& read) const;
  static void listMessages(const std::map<std::uint32_t, const BagConnection*>& wanted, ReadChunk& read);

  int descriptor_;
  std::uint64_t size_{};
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<BagChunk> chunks_;
  rosbag::ChunkedFile no_file_;  ///< the streams, which unpack chunks, want one
  rosbag::StreamFactory streams_{&no_file_};
};

}  // namespace hammer_loads
