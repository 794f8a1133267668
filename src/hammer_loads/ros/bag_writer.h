/// Writing a bag of format 2.0 with LZ4: rosbag::Bag asks the system for the file's end with each message, which takes
/// most of its time.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hammer_loads {

/// A bag that is being written; what was not closed is no bag. Every function throws std::system_error where the file
/// cannot be written.
class BagWriter {
 public:
  explicit BagWriter(const std::string& file);
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  ~BagWriter();

  /// latched: as a latched publisher's message, which rosbag play keeps for late subscribers.
  template <typename Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message, bool latched = false) {
    const std::uint32_t size = ros::serialization::serializationLength(message);
    std::uint8_t* place = beginMessage(connectionOf<Message>(topic, latched), time, size);
    ros::serialization::OStream stream(place, size);
    ros::serialization::serialize(stream, message);
    endMessage();
  }
  /// Writes the rest and the index.
  void close();

 private:
  struct Connection {
    std::string topic, type, md5sum, definition;
    bool latched{};
  };
  struct ChunkInfo {
    std::uint64_t position{};
    ros::Time first, last;
    std::map<std::uint32_t, std::uint32_t> counts;  ///< messages by connection
  };
  using Places = std::vector<std::pair<ros::Time, std::uint32_t>>;  ///< of messages in their chunk

  template <typename Message>
  std::uint32_t connectionOf(const std::string& topic, bool latched) {
    const auto known = numbers_.find(topic);
    if (known != numbers_.end()) return known->second;
    return addConnection({topic, ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(),
                          ros::message_traits::definition<Message>(), latched});
  }
  std::uint32_t addConnection(Connection connection);
  std::string recordOf(std::uint32_t connection) const;
  std::uint8_t* beginMessage(std::uint32_t connection, const ros::Time& time, std::uint32_t size);
  void endMessage();
  void writeChunk();
  void writeBagHeader(std::uint64_t index_position);
  void writeBytes(const std::string& bytes);

  int descriptor_;
  std::uint64_t position_{};  ///< end of the file
  std::vector<Connection> connections_;
  std::map<std::string, std::uint32_t> numbers_;  ///< of the connections, by topic
  std::vector<ChunkInfo> chunks_;                 ///< the last one is being filled
  std::string chunk_, packed_;                    ///< bytes of that one
  std::map<std::uint32_t, Places> index_;         ///< as above, by connection
};

}  // namespace hammer_loads
