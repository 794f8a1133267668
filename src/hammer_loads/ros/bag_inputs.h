/// Recorded bags as one input: the splits of a recording in record order. Also a check whether a bag may be replaced. A
/// bag is read chunk by chunk. Unlike rosbag::Bag, the reader keeps no index of all messages, so that its memory does
/// not grow with the recording. Format: wiki.ros.org/Bags/Format/2.0.
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
  std::string publisher;  ///< name of the node; empty if the bag does not state it
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
  /// Deserialises into a message, which may be reused. Throws std::runtime_error if the message is damaged or has
  /// another definition.
  template <typename Message>
  void to(Message& message) const {
    if (!is<Message>())
      throw std::runtime_error("a message on " + connection->topic + " cannot be read: of another definition");
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(data), size);  // the stream only reads
    ros::serialization::deserialize(stream, message);
  }
};

/// Position, times and content of a chunk, from the index at the bag's end.
struct BagChunk {
  std::uint64_t position{};                       ///< in the file
  ros::Time first, last;                          ///< record times of its messages
  std::map<std::uint32_t, std::uint32_t> counts;  ///< messages by connection
};

/// Messages of one chunk, with its bytes before and after unpacking.
struct ReadChunk {
  std::vector<std::uint8_t> packed, bytes;
  std::vector<BagMessage> messages;
};

class BagFile {
 public:
  /// Opens a bag and reads its index. Throws rosbag::BagUnindexedException for a recording that was not closed, and
  /// std::runtime_error for a file that is no bag.
  explicit BagFile(const std::string& file);
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;
  ~BagFile();

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  const std::vector<BagChunk>& chunks() const { return chunks_; }
  /// Reads the chunk's messages on these connections, in the order of record times; equal times stay in file order.
  /// `read` keeps its memory from chunk to chunk. Throws std::runtime_error if the chunk is damaged.
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
  rosbag::ChunkedFile no_file_;  ///< required by the streams that unpack chunks
  rosbag::StreamFactory streams_{&no_file_};
};

/// Filter of the wanted connections.
using BagQuery = std::function<bool(const BagConnection&)>;
/// Filter of the chunks that may contain wanted messages, by their times. Empty: all.
using ChunkQuery = std::function<bool(const BagChunk&)>;

/// Reader of messages in record order. Only chunks whose times overlap at the current position are held in memory.
/// Messages with equal times are in the order of the bags, then of the file.
class BagMessages {
 public:
  /// The bags must outlive the reader. They must not be read by others in the meantime.
  BagMessages(const std::vector<std::unique_ptr<BagFile>>& bags, const BagQuery& query, const ChunkQuery& chunks = {});

  /// Returns the next message, valid until the next call, or null. Throws std::runtime_error if a bag is damaged.
  const BagMessage* next();
  /// Returns the number of wanted messages in all wanted chunks.
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
    std::size_t place;  ///< index in places_
    std::size_t at;     ///< index in read.messages
    ReadChunk read;
    const BagMessage& message() const { return read.messages[at]; }
  };
  static bool isLater(const std::unique_ptr<OpenChunk>& a, const std::unique_ptr<OpenChunk>& b);
  void open(std::size_t place);
  void passMessage();

  std::vector<Source> sources_;
  std::vector<Place> places_;                      ///< chunks with wanted messages, by their first time
  std::size_t next_place_{};                       ///< place of the next chunk to be opened
  std::vector<std::unique_ptr<OpenChunk>> open_;   ///< heap; the first chunk has the earliest message
  std::vector<std::unique_ptr<OpenChunk>> spare_;  ///< chunks whose memory is reused
  bool given_{};                                   ///< the first chunk's message was returned to the caller
  std::uint64_t size_{};
};

/// A topic of the bags.
struct BagTopic {
  std::set<std::string> types;        ///< types such as `sensor_msgs/JointState`
  std::set<std::string> definitions;  ///< MD5 sums of the types
  std::set<std::string> publishers;   ///< names of the nodes; empty if the bag does not state them
};

/// Returns the name of a message's type.
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
  /// Returns the names and types of the topics in one line.
  std::string topicList() const;
  /// Returns the names of the topics of this type in one line; "none" if there are none.
  std::string topicsOfType(const std::string& type) const;
  /// Returns the record times of the first and last message of the chunks with the topic; for an empty name, those of
  /// all chunks. The times are zero if there is none. Messages recorded before the first message of /clock have times
  /// near 0 and are ignored.
  std::pair<ros::Time, ros::Time> span(const std::string& topic = {}) const;
  /// Returns the files' names in one line.
  const std::string& names() const { return names_; }
  /// Returns the messages of every bag that the query accepts, in record order. Only one reader may exist at a time.
  BagMessages messages(const BagQuery& query, const ChunkQuery& chunks = {}) const { return {bags_, query, chunks}; }
  BagMessages messagesOn(const std::set<std::string>& topics) const;

 private:
  void addTopics(const BagFile& bag);

  std::vector<std::unique_ptr<BagFile>> bags_;
  std::map<std::string, BagTopic> topics_;
  std::string names_;
};

/// Returns the reason why an existing file must stay. It is empty for a bag that has only outputs of this package, as
/// process_bag writes it. A recording of inputs or a node's log must stay.
std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics);

}  // namespace hammer_loads
