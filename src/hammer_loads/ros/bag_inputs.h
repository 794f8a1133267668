/// Recorded bags as one input: the splits of a recording, in record order; and whether a bag may be replaced. A bag is
/// read chunk by chunk. Unlike rosbag::Bag its reader keeps no index of every message, so that its memory does not grow
/// with the recording. Format: wiki.ros.org/Bags/Format/2.0.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>
#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/util/checked.h"

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

/// A topic of the bags.
struct BagTopic {
  std::set<std::string> types;        ///< types such as `sensor_msgs/JointState`
  std::set<std::string> definitions;  ///< MD5 sums of the types
  std::set<std::string> publishers;   ///< names of the nodes; empty where the bag does not state it
};

/// Name of a message's type.
template <typename Message>
std::string typeOf() {
  return ros::message_traits::datatype<Message>();
}

class BagInputs {
 public:
  /// Opens every bag. Returns one line for each that cannot be opened.
  static Checked<BagInputs> open(const std::vector<std::string>& files);

  const std::map<std::string, BagTopic>& topics() const { return topics_; }
  bool has(const std::string& topic) const { return topics_.count(topic) != 0; }
  /// Names and types of the topics, in one line.
  std::string topicList() const;
  /// Names of the topics of this type, in one line; "none" if there are none.
  std::string topicsOfType(const std::string& type) const;
  /// Record times of the first and last message of the chunks with the topic, or of all chunks for an empty name; zero
  /// if there is none. Messages that were recorded before the first message of /clock have times near 0 and do not
  /// count.
  std::pair<ros::Time, ros::Time> span(const std::string& topic = {}) const;
  /// The files' names, in one line.
  const std::string& names() const { return names_; }
  /// Messages of every bag that the query takes, in record order. One reader at a time.
  BagMessages messages(const BagQuery& query, const ChunkQuery& chunks = {}) const { return {bags_, query, chunks}; }
  BagMessages messagesOn(const std::set<std::string>& topics) const;

 private:
  void addTopics(const BagFile& bag);

  std::vector<std::unique_ptr<BagFile>> bags_;
  std::map<std::string, BagTopic> topics_;
  std::string names_;
};

/// Reason why an existing file must stay; empty: it is a bag of this package's outputs alone, as process_bag writes it.
/// A recording of inputs or a node's log must stay.
std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics);

}  // namespace hammer_loads
