/// to_mcap: any bag in, the same messages as MCAP out.
#include <console_bridge/console.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/log/bag_record.h"

namespace hammer_loads {
namespace {

constexpr char kMagic[] = "\x89MCAP0\r\n";
constexpr std::size_t kChunkSize = 768 * 1024;  // [byte], as the format's own writers

enum Kind : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd
};

std::string record(Kind kind, const std::string& content) {
  return bytesOf<std::uint8_t>(kind) + bytesOf<std::uint64_t>(content.size()) + content;
}

std::string numbersOf(const std::map<std::uint16_t, std::uint64_t>& values) {
  std::string bytes;
  for (const auto& [key, value] : values) bytes += bytesOf(key) + bytesOf(value);
  return pieceOf(bytes);
}

std::uint32_t crcOf(const std::string& bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::uint16_t nextNumber(std::size_t known) {
  if (known >= std::numeric_limits<std::uint16_t>::max())
    throw std::length_error("more topics than MCAP numbers (65535)");
  return static_cast<std::uint16_t>(known + 1);
}

/// An MCAP file (mcap.dev/spec, version 0) of profile ros1 that is being written: chunks without compression, with
/// CRCs, indexes and summary. It is valid only once it is closed. Throws std::ios_base::failure where the file cannot
/// be written.
class McapWriter {
 public:
  using Metadata = std::map<std::string, std::string>;

  McapWriter(const std::string& file, const std::string& library) {
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    stream_.open(file, std::ios::binary);
    put(kMagic + record(kHeader, pieceOf("ros1") + pieceOf(library)));
  }
  /// Number of a message definition, for addChannel().
  std::uint16_t addSchema(const std::string& type, const std::string& definition) {
    const std::uint16_t id = nextNumber(schemas_.size());
    schemas_.push_back(record(kSchema, bytesOf(id) + pieceOf(type) + pieceOf("ros1msg") + pieceOf(definition)));
    chunk_ += schemas_.back();
    return id;
  }
  std::uint16_t addChannel(std::uint16_t schema, const std::string& topic, const Metadata& metadata) {
    const std::uint16_t id = nextNumber(channels_.size());
    std::string pairs;
    for (const auto& [key, value] : metadata) pairs += pieceOf(key) + pieceOf(value);
    channels_.push_back(
        record(kChannel, bytesOf(id) + bytesOf(schema) + pieceOf(topic) + pieceOf("ros1") + pieceOf(pairs)));
    chunk_ += channels_.back();
    return id;
  }
  /// time [ns].
  void write(std::uint16_t channel, std::uint64_t time, const std::string& bytes) {
    places_[channel].emplace_back(time, chunk_.size());
    const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
    chunk_ += record(kMessage, bytesOf(channel) + bytesOf(sequence) + bytesOf(time) + bytesOf(time) + bytes);
    if (chunk_.size() >= kChunkSize) writeChunk();
  }
  /// Writes the rest and the summary.
  void close() {
    writeChunk();
    put(record(kDataEnd, bytesOf(static_cast<std::uint32_t>(data_crc_.checksum()))));
    const std::uint64_t begin = position_;
    std::string summary, offsets;
    const auto add = [&](Kind kind, const std::vector<std::string>& records) {
      const std::uint64_t at = begin + summary.size();
      for (const std::string& one : records) summary += one;
      const std::uint64_t size = begin + summary.size() - at;
      if (size > 0) offsets += record(kSummaryOffset, bytesOf<std::uint8_t>(kind) + bytesOf(at) + bytesOf(size));
    };
    add(kSchema, schemas_);
    add(kChannel, channels_);
    add(kStatistics, {statistics()});
    add(kChunkIndex, chunk_indexes_);
    const std::uint64_t offsets_at = begin + summary.size();
    constexpr std::uint64_t kFooterSize = 8 + 8 + 4;
    summary += offsets + bytesOf<std::uint8_t>(kFooter) + bytesOf(kFooterSize) + bytesOf(begin) + bytesOf(offsets_at);
    put(summary + bytesOf(crcOf(summary)) + kMagic);
    stream_.close();
  }

 private:
  static constexpr std::uint64_t kLatest = std::numeric_limits<std::uint64_t>::max();
  using Places = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< time [ns] and place in the chunk

  void put(const std::string& bytes) {
    stream_ << bytes;
    data_crc_.process_bytes(bytes.data(), bytes.size());
    position_ += bytes.size();
  }
  void writeChunk() {
    if (places_.empty()) return;
    const std::uint64_t begin = position_;
    std::uint64_t first = kLatest, last = 0;
    for (auto& [channel, places] : places_) {
      std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      first = std::min(first, places.front().first), last = std::max(last, places.back().first);
    }
    first_ = std::min(first, first_), last_ = std::max(last, last_);
    const std::string times = bytesOf(first) + bytesOf(last);
    const auto size = bytesOf<std::uint64_t>(chunk_.size());
    put(record(kChunk, times + size + bytesOf(crcOf(chunk_)) + pieceOf("") + size + chunk_));
    const std::uint64_t end = position_;
    std::map<std::uint16_t, std::uint64_t> indexes;
    for (const auto& [channel, places] : places_) {
      std::string entries;
      for (const auto& [time, place] : places) entries += bytesOf(time) + bytesOf(place);
      indexes[channel] = position_;
      put(record(kMessageIndex, bytesOf(channel) + pieceOf(entries)));
    }
    chunk_indexes_.push_back(record(kChunkIndex, times + bytesOf(begin) + bytesOf(end - begin) + numbersOf(indexes) +
                                                     bytesOf(position_ - end) + pieceOf("") + size + size));
    chunk_.clear();
    places_.clear();
  }
  std::string statistics() const {
    std::uint64_t messages = 0;
    for (const auto& [channel, count] : counts_) messages += count;
    const auto count = [](const auto& records) { return bytesOf(static_cast<std::uint32_t>(records.size())); };
    return record(kStatistics, bytesOf(messages) + bytesOf(static_cast<std::uint16_t>(schemas_.size())) +
                                   count(channels_) + bytesOf(std::uint32_t{0}) + bytesOf(std::uint32_t{0}) +
                                   count(chunk_indexes_) + bytesOf(messages > 0 ? first_ : 0) + bytesOf(last_) +
                                   numbersOf(counts_));
  }

  std::ofstream stream_;
  std::uint64_t position_{};
  boost::crc_32_type data_crc_;
  std::vector<std::string> schemas_, channels_, chunk_indexes_;  ///< records
  std::map<std::uint16_t, std::uint64_t> counts_;                ///< messages by channel
  std::string chunk_;
  std::uint64_t first_{kLatest}, last_{};   ///< times of the messages in chunks [ns]
  std::map<std::uint16_t, Places> places_;  ///< places of the chunk's messages, by channel
};

constexpr char kLibrary[] = "hammer_loads to_mcap";

/// Reason why an existing file must stay; empty: this command wrote it.
std::string whyMcapMustStay(const std::string& name) {
  std::string begin(64, '\0');
  std::ifstream(name, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  const bool ours = begin.compare(1, 4, "MCAP") == 0 && begin.find(kLibrary) != std::string::npos;
  return ours ? "" : "it is no MCAP of this command";
}

/// Publisher and type of a connection's messages (profile ros1).
McapWriter::Metadata metadataOf(const rosbag::ConnectionInfo& connection) {
  McapWriter::Metadata metadata{{"md5sum", connection.md5sum}};
  if (!connection.header) return metadata;
  const auto caller = connection.header->find("callerid"), latching = connection.header->find("latching");
  if (caller != connection.header->end()) metadata["callerid"] = caller->second;
  if (latching != connection.header->end()) metadata["latching"] = latching->second == "1" ? "true" : "false";
  return metadata;
}

/// Number of messages written.
std::uint64_t convert(const std::string& input, const std::string& output) {
  rosbag::Bag bag(input);
  rosbag::View view(bag);
  McapWriter writer(output, kLibrary);
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas;  // by type and md5
  std::map<const ros::M_string*, std::uint16_t> channels;  // by header: a message leads to that of its connection alone
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto [schema, is_new] = schemas.try_emplace({connection->datatype, connection->md5sum});
    if (is_new) schema->second = writer.addSchema(connection->datatype, connection->msg_def);
    channels[connection->header.get()] = writer.addChannel(schema->second, connection->topic, metadataOf(*connection));
  }
  std::uint64_t count = 0;
  std::string bytes;
  for (const rosbag::MessageInstance& message : view) {
    bytes.resize(message.size());
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    writer.write(channels.at(message.getConnectionHeader().get()), message.getTime().toNSec(), bytes);
    ++count;
  }
  writer.close();
  return count;
}

int run(int argc, const char* const* argv) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  CommandLine line("Every message of a bag as MCAP, profile ros1", "to_mcap");
  std::string input, output;
  bool force = false;
  line.add_option("input", input, "any bag")->required()->type_name("IN.bag");
  line.add_option("output", output, "to write, which must not exist")->required()->type_name("OUT.mcap");
  line.add_flag("--force", force, "replace OUT.mcap if this command wrote it");
  if (const auto code = line.parse(argc, argv)) return *code;
  endCleanlyOnSignals();
  Checked<OutputFile> file = OutputFile::make({output, {input}, force, whyMcapMustStay});
  if (!file.value) return fail(file.problems);
  std::string problem;
  std::uint64_t count = 0;
  try {
    count = convert(input, file.value->path());
    problem = file.value->publish();
  } catch (const std::ios_base::failure&) {
    problem = output + ": cannot be written";
  } catch (const std::exception& error) {
    problem = input + ": cannot be read: " + error.what();
  }
  if (!problem.empty()) return fail({problem});
  std::cout << output << ": " << count << " messages" << std::endl;
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
