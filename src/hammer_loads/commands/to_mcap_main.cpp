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

/// Little end first on every machine.
template <typename T>
std::string number(T value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i)
    bytes += static_cast<char>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xffU);
  return bytes;
}

std::string text(const std::string& value) {
  if (value.size() > std::numeric_limits<std::uint32_t>::max()) throw std::length_error("a text is too long for MCAP");
  return number(static_cast<std::uint32_t>(value.size())) + value;
}

std::string record(Kind kind, const std::string& content) {
  return number<std::uint8_t>(kind) + number<std::uint64_t>(content.size()) + content;
}

std::string numbersOf(const std::map<std::uint16_t, std::uint64_t>& values) {
  std::string bytes;
  for (const auto& [key, value] : values) bytes += number(key) + number(value);
  return text(bytes);
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
    put(kMagic + record(kHeader, text("ros1") + text(library)));
  }
  /// Number of a message definition, for addChannel().
  std::uint16_t addSchema(const std::string& type, const std::string& definition) {
    const std::uint16_t id = nextNumber(schemas_.size());
    schemas_.push_back(record(kSchema, number(id) + text(type) + text("ros1msg") + text(definition)));
    chunk_ += schemas_.back();
    return id;
  }
  std::uint16_t addChannel(std::uint16_t schema, const std::string& topic, const Metadata& metadata) {
    const std::uint16_t id = nextNumber(channels_.size());
    std::string pairs;
    for (const auto& [key, value] : metadata) pairs += text(key) + text(value);
    channels_.push_back(record(kChannel, number(id) + number(schema) + text(topic) + text("ros1") + text(pairs)));
    chunk_ += channels_.back();
    return id;
  }
  /// time [ns].
  void write(std::uint16_t channel, std::uint64_t time, const std::string& bytes) {
    places_[channel].emplace_back(time, chunk_.size());
    const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
    chunk_ += record(kMessage, number(channel) + number(sequence) + number(time) + number(time) + bytes);
    chunk_span_.add(time);
    span_.add(time);
    if (chunk_.size() >= kChunkSize) writeChunk();
  }
  /// Writes the rest and the summary.
  void close() {
    writeChunk();
    put(record(kDataEnd, number(static_cast<std::uint32_t>(data_crc_.checksum()))));
    const std::uint64_t begin = position_;
    std::string summary, offsets;
    const auto add = [&](Kind kind, const std::vector<std::string>& records) {
      const std::uint64_t at = begin + summary.size();
      for (const std::string& one : records) summary += one;
      const std::uint64_t size = begin + summary.size() - at;
      if (size > 0) offsets += record(kSummaryOffset, number<std::uint8_t>(kind) + number(at) + number(size));
    };
    add(kSchema, schemas_);
    add(kChannel, channels_);
    add(kStatistics, {statistics()});
    add(kChunkIndex, chunk_indexes_);
    const std::uint64_t offsets_at = begin + summary.size();
    constexpr std::uint64_t kFooterSize = 8 + 8 + 4;
    summary += offsets + number<std::uint8_t>(kFooter) + number(kFooterSize) + number(begin) + number(offsets_at);
    put(summary + number(crcOf(summary)) + kMagic);
    stream_.close();
  }

 private:
  struct Span {
    std::uint64_t first{~std::uint64_t{0}}, last{};  ///< [ns]
    void add(std::uint64_t time) {
      first = std::min(first, time);
      last = std::max(last, time);
    }
  };
  using Places = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< time [ns] and place in the chunk

  void put(const std::string& bytes) {
    stream_ << bytes;
    data_crc_.process_bytes(bytes.data(), bytes.size());
    position_ += bytes.size();
  }
  void writeChunk() {
    if (places_.empty()) return;
    const std::uint64_t begin = position_;
    const std::string times = number(chunk_span_.first) + number(chunk_span_.last);
    const auto size = number<std::uint64_t>(chunk_.size());
    put(record(kChunk, times + size + number(crcOf(chunk_)) + text("") + size + chunk_));
    const std::uint64_t end = position_;
    std::map<std::uint16_t, std::uint64_t> indexes;
    for (auto& [channel, places] : places_) {
      std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      std::string entries;
      for (const auto& [time, place] : places) entries += number(time) + number(place);
      indexes[channel] = position_;
      put(record(kMessageIndex, number(channel) + text(entries)));
    }
    chunk_indexes_.push_back(record(kChunkIndex, times + number(begin) + number(end - begin) + numbersOf(indexes) +
                                                     number(position_ - end) + text("") + size + size));
    chunk_.clear();
    places_.clear();
    chunk_span_ = {};
  }
  std::string statistics() const {
    std::uint64_t messages = 0;
    for (const auto& [channel, count] : counts_) messages += count;
    const auto count = [](const auto& records) { return number(static_cast<std::uint32_t>(records.size())); };
    return record(kStatistics, number(messages) + number(static_cast<std::uint16_t>(schemas_.size())) +
                                   count(channels_) + number(std::uint32_t{0}) + number(std::uint32_t{0}) +
                                   count(chunk_indexes_) + number(messages > 0 ? span_.first : 0) + number(span_.last) +
                                   numbersOf(counts_));
  }

  std::ofstream stream_;
  std::uint64_t position_{};
  boost::crc_32_type data_crc_;
  std::vector<std::string> schemas_, channels_, chunk_indexes_;  ///< records
  std::map<std::uint16_t, std::uint64_t> counts_;                ///< messages by channel
  std::string chunk_;
  Span chunk_span_, span_;
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
  std::map<std::uint32_t, std::uint16_t> channels;                       // by connection
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto [schema, is_new] = schemas.try_emplace({connection->datatype, connection->md5sum});
    if (is_new) schema->second = writer.addSchema(connection->datatype, connection->msg_def);
    channels[connection->id] = writer.addChannel(schema->second, connection->topic, metadataOf(*connection));
  }
  std::map<const ros::M_string*, std::uint16_t> by_header;  // a message leads to its connection's header alone
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    by_header[connection->header.get()] = channels[connection->id];
  std::uint64_t count = 0;
  std::string bytes;
  for (const rosbag::MessageInstance& message : view) {
    bytes.resize(message.size());
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    writer.write(by_header.at(message.getConnectionHeader().get()), message.getTime().toNSec(), bytes);
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
