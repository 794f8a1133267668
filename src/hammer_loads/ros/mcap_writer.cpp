#include "hammer_loads/ros/mcap_writer.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

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

}  // namespace

void McapWriter::Span::add(std::uint64_t time) {
  first = std::min(first, time);
  last = std::max(last, time);
}

McapWriter::McapWriter(const std::string& file, const std::string& library) {
  stream_.exceptions(std::ios::failbit | std::ios::badbit);
  stream_.open(file, std::ios::binary);
  put(kMagic + record(kHeader, text("ros1") + text(library)));
}

void McapWriter::put(const std::string& bytes) {
  stream_ << bytes;
  data_crc_.process_bytes(bytes.data(), bytes.size());
  position_ += bytes.size();
}

std::uint16_t McapWriter::addSchema(const std::string& type, const std::string& definition) {
  const std::uint16_t id = nextNumber(schemas_.size());
  schemas_.push_back(record(kSchema, number(id) + text(type) + text("ros1msg") + text(definition)));
  chunk_ += schemas_.back();
  return id;
}

std::uint16_t McapWriter::addChannel(std::uint16_t schema, const std::string& topic, const Metadata& metadata) {
  const std::uint16_t id = nextNumber(channels_.size());
  std::string pairs;
  for (const auto& [key, value] : metadata) pairs += text(key) + text(value);
  channels_.push_back(record(kChannel, number(id) + number(schema) + text(topic) + text("ros1") + text(pairs)));
  chunk_ += channels_.back();
  return id;
}

void McapWriter::write(std::uint16_t channel, std::uint64_t time, const std::string& bytes) {
  places_[channel].emplace_back(time, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  chunk_ += record(kMessage, number(channel) + number(sequence) + number(time) + number(time) + bytes);
  chunk_span_.add(time);
  span_.add(time);
  if (chunk_.size() >= kChunkSize) writeChunk();
}

void McapWriter::writeChunk() {
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

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  const auto count = [](const auto& records) { return number(static_cast<std::uint32_t>(records.size())); };
  return record(kStatistics, number(messages) + number(static_cast<std::uint16_t>(schemas_.size())) + count(channels_) +
                                 number(std::uint32_t{0}) + number(std::uint32_t{0}) + count(chunk_indexes_) +
                                 number(messages > 0 ? span_.first : 0) + number(span_.last) + numbersOf(counts_));
}

void McapWriter::close() {
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

}  // namespace hammer_loads
