#include "hammer_loads/log/bag_writer.h"

#include <fcntl.h>
#include <roslz4/lz4s.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "hammer_loads/log/bag_record.h"

namespace hammer_loads {
namespace {

constexpr std::uint32_t kBagHeader = 4096;  // header and padding, so that the header can be rewritten at the end [byte]
constexpr int kBlock = 6;                   // code of the LZ4 block size, as in rosbag: 1 MB
constexpr std::uint64_t kRecord = 128;      // largest header of a record without texts [byte]
constexpr std::uint64_t kIndexEntry = 12;   // time and offset of one message [byte]

[[noreturn]] void fail() { throw std::system_error(errno, std::generic_category()); }

void addField(std::string& header, const std::string& name, const std::string& value) {
  header += bytesOf(static_cast<std::uint32_t>(name.size() + 1 + value.size())) + name + "=" + value;
}

std::string headerOf(BagRecord::Kind kind) {
  std::string header;
  addField(header, "op", std::string(1, static_cast<char>(kind)));
  return header;
}

/// Returns the largest possible size of `size` bytes after compression.
std::size_t packedBound(std::size_t size) { return size + size / 64 + 4096; }

}  // namespace

BagWriter::BagWriter(const std::string& file, std::size_t chunk_size, LogCompression compression)
    : chunk_size_(chunk_size),
      compression_(compression),
      descriptor_(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail();
  writeBytes(std::string(kBagMagic));
  writeBagHeader(0);
  chunks_.emplace_back();
}

BagWriter::~BagWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void BagWriter::writeBytes(const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    done += static_cast<std::size_t>(count);
  }
  position_ += bytes.size();
}

/// Writes the header of the bag. index_position: 0 if the index is not written yet.
void BagWriter::writeBagHeader(std::uint64_t index_position) {
  std::string header = headerOf(BagRecord::kBag);
  addField(header, "index_pos", bytesOf(index_position));
  addField(header, "conn_count", bytesOf(static_cast<std::uint32_t>(connections_.size())));
  addField(header, "chunk_count", bytesOf(static_cast<std::uint32_t>(chunks_.size())));
  writeBytes(pieceOf(header) + pieceOf(std::string(kBagHeader - header.size(), ' ')));
}

std::uint32_t BagWriter::addConnection(Connection connection) {
  const auto number = static_cast<std::uint32_t>(connections_.size());
  numbers_[connection.topic] = number;
  connections_.push_back(std::move(connection));
  const std::string record = recordOf(number);
  chunk_ += record;
  index_size_ += record.size();
  return number;
}

std::string BagWriter::recordOf(std::uint32_t number) const {
  const Connection& connection = connections_[number];
  std::string header = headerOf(BagRecord::kConnection), data;
  addField(header, "conn", bytesOf(number));
  addField(header, "topic", connection.topic);
  addField(data, "topic", connection.topic);
  addField(data, "type", connection.type);
  addField(data, "md5sum", connection.md5sum);
  addField(data, "message_definition", connection.definition);
  if (!connection.caller.empty()) addField(data, "callerid", connection.caller);
  if (connection.latched) addField(data, "latching", "1");
  return pieceOf(header) + pieceOf(data);
}

/// Appends a message's header, which always has the same length, and returns the place for the message.
std::uint8_t* BagWriter::beginMessage(std::uint32_t connection, const ros::Time& time, std::uint32_t size) {
  ChunkInfo& chunk = chunks_.back();
  if (chunk.counts.empty()) chunk.first = chunk.last = time;
  chunk.first = std::min(chunk.first, time);
  chunk.last = std::max(chunk.last, time);
  ++chunk.counts[connection];
  ++messages_;
  index_[connection].emplace_back(time, static_cast<std::uint32_t>(chunk_.size()));

  static const std::string kPattern = [] {
    std::string header = headerOf(BagRecord::kMessage);
    addField(header, "conn", bytesOf(std::uint32_t{0}));
    addField(header, "time", bytesOf(std::uint64_t{0}));
    return pieceOf(header);
  }();
  constexpr std::size_t kConnectionFromEnd = 8 + 5 + 4 + 4, kTimeFromEnd = 8;
  chunk_ += kPattern;
  char* end = chunk_.data() + chunk_.size();
  std::memcpy(end - kConnectionFromEnd, &connection, sizeof connection);
  std::memcpy(end - kTimeFromEnd, &time.sec, sizeof time.sec);
  std::memcpy(end - kTimeFromEnd + sizeof time.sec, &time.nsec, sizeof time.nsec);
  chunk_ += bytesOf(size);
  chunk_.resize(chunk_.size() + size);
  return reinterpret_cast<std::uint8_t*>(chunk_.data() + chunk_.size() - size);
}

void BagWriter::endMessage() {
  if (chunk_.size() >= chunk_size_) closeChunk();
}

std::uint64_t BagWriter::sizeBound() const noexcept {
  const std::uint64_t of_chunk =
      packedBound(chunk_.size()) + kRecord + kRecord * index_.size() + kIndexEntry * messages_;
  return position_ + of_chunk + index_size_ + kRecord + 8 * connections_.size();
}

void BagWriter::closeChunk() {
  if (chunk_.empty()) return;
  std::string header = headerOf(BagRecord::kChunk);
  if (compression_ == LogCompression::kLz4) {
    packed_.resize(packedBound(chunk_.size()));
    auto size = static_cast<unsigned>(packed_.size());
    if (roslz4_buffToBuffCompress(chunk_.data(), static_cast<unsigned>(chunk_.size()), packed_.data(), &size, kBlock) !=
        ROSLZ4_OK)
      throw std::runtime_error("LZ4 cannot pack a chunk");
    packed_.resize(size);
  }
  const std::string& data_of_chunk = compression_ == LogCompression::kLz4 ? packed_ : chunk_;
  chunks_.back().position = position_;
  addField(header, "compression", compression_ == LogCompression::kLz4 ? "lz4" : "none");
  addField(header, "size", bytesOf(static_cast<std::uint32_t>(chunk_.size())));
  writeBytes(pieceOf(header) + bytesOf(static_cast<std::uint32_t>(data_of_chunk.size())));
  writeBytes(data_of_chunk);
  for (auto& [connection, places] : index_) {
    if (places.empty()) continue;
    std::string index = headerOf(BagRecord::kIndex), data;
    addField(index, "ver", bytesOf(std::uint32_t{1}));
    addField(index, "conn", bytesOf(connection));
    addField(index, "count", bytesOf(static_cast<std::uint32_t>(places.size())));
    std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [time, offset] : places) data += bytesOf(time) + bytesOf(offset);
    writeBytes(pieceOf(index) + pieceOf(data));
    places.clear();
  }
  chunk_.clear();
  messages_ = 0;
  index_size_ += kRecord + 8 * chunks_.back().counts.size();
  chunks_.emplace_back();
}

void BagWriter::close() {
  closeChunk();
  chunks_.pop_back();
  const std::uint64_t index_position = position_;
  std::string index;
  for (std::uint32_t i = 0; i < connections_.size(); ++i) index += recordOf(i);
  for (const ChunkInfo& chunk : chunks_) {
    std::string header = headerOf(BagRecord::kChunkInfo), data;
    addField(header, "ver", bytesOf(std::uint32_t{1}));
    addField(header, "chunk_pos", bytesOf(chunk.position));
    addField(header, "start_time", bytesOf(chunk.first));
    addField(header, "end_time", bytesOf(chunk.last));
    addField(header, "count", bytesOf(static_cast<std::uint32_t>(chunk.counts.size())));
    for (const auto& [connection, count] : chunk.counts) data += bytesOf(connection) + bytesOf(count);
    index += pieceOf(header) + pieceOf(data);
  }
  writeBytes(index);
  if (lseek(descriptor_, kBagMagic.size(), SEEK_SET) < 0) fail();
  writeBagHeader(index_position);
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) fail();
}

}  // namespace hammer_loads
