#include <fcntl.h>
#include <rosbag/exceptions.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hammer_loads/log/bag_record.h"
#include "hammer_loads/ros/bag_inputs.h"

namespace hammer_loads {
namespace {

constexpr std::uint64_t kMostChunk = std::uint64_t{1} << 30U;  // largest unpacked chunk [byte]; rosbag writes about 1e6
// Largest ratio of unpacked to packed bytes, for the part of a chunk beyond rosbag's usual size. LZ4 packs to 1/255 at
// most; messages with stamps are packed less.
constexpr std::uint64_t kMostPacked = 255, kUsualChunk = 1U << 20U;

rosbag::CompressionType packingOf(std::string_view name) {
  if (name == "none") return rosbag::compression::Uncompressed;
  if (name == "bz2") return rosbag::compression::BZ2;
  if (name == "lz4") return rosbag::compression::LZ4;
  throw std::runtime_error("chunk with the unknown compression " + std::string(name));
}

BagConnection connectionOf(const BagRecord& record) {
  const auto text = [](std::string_view header, const char* name) { return std::string(fieldOf(header, name)); };
  return {text(record.header, "topic"), text(record.data, "type"), text(record.data, "md5sum"),
          text(record.data, "callerid")};
}

BagChunk chunkOf(const BagRecord& record) {
  BagChunk chunk;
  chunk.position = numberOf<std::uint64_t>(record.header, "chunk_pos");
  chunk.first = timeIn(record.header, "start_time");
  chunk.last = timeIn(record.header, "end_time");
  std::string_view counts = record.data;
  for (auto left = numberOf<std::uint32_t>(record.header, "count"); left > 0; --left) {
    const auto connection = numberIn<std::uint32_t>(counts);
    counts.remove_prefix(sizeof connection);
    chunk.counts[connection] += numberIn<std::uint32_t>(counts);
    counts.remove_prefix(sizeof(std::uint32_t));
  }
  return chunk;
}

}  // namespace

BagFile::BagFile(const std::string& file) : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat found {};
  if (descriptor_ < 0 || fstat(descriptor_, &found) != 0) throw std::runtime_error(std::strerror(errno));
  size_ = static_cast<std::uint64_t>(found.st_size);
  constexpr std::size_t kBagHeader = 4096;  // size of the bag's header with its padding
  const std::string beginning = bytesAt(0, std::min<std::uint64_t>(size_, kBagMagic.size() + kBagHeader + 100));
  std::string_view rest = beginning;
  if (rest.substr(0, 9) != kBagMagic.substr(0, 9)) throw std::runtime_error("it does not begin as a bag");
  if (rest.substr(0, kBagMagic.size()) != kBagMagic)
    throw std::runtime_error("a bag of another format than 2.0; `rosbag fix` converts it");
  rest.remove_prefix(kBagMagic.size());
  const std::string_view header = BagRecord::take(rest).header;
  if (numberOf<std::uint8_t>(header, "op") != BagRecord::kBag) throw std::runtime_error("it has no bag header");
  if (!fieldOf(header, "encryptor").empty())
    throw std::runtime_error("it is encrypted; `rosbag decrypt` makes it plain");
  const auto index = numberOf<std::uint64_t>(header, "index_pos");
  if (index == 0) throw rosbag::BagUnindexedException();
  readIndex(index, numberOf<std::uint32_t>(header, "conn_count"), numberOf<std::uint32_t>(header, "chunk_count"));
}

BagFile::~BagFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void BagFile::readInto(std::uint64_t position, std::uint8_t* to, std::size_t size) const {
  if (position > size_ || size > size_ - position) throw std::runtime_error("a record reaches beyond the file's end");
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = pread(descriptor_, to + done, size - done, static_cast<off_t>(position + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw std::runtime_error(count < 0 ? std::strerror(errno) : "the file has become shorter");
    done += static_cast<std::size_t>(count);
  }
}

std::string BagFile::bytesAt(std::uint64_t position, std::uint64_t size) const {
  if (size > size_) throw std::runtime_error("a record reaches beyond the file's end");  // before memory is allocated
  std::string bytes(size, '\0');
  readInto(position, reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  return bytes;
}

void BagFile::readIndex(std::uint64_t position, std::uint32_t connections, std::uint32_t chunks) {
  if (position > size_) throw std::runtime_error("its index is missing");
  const std::string bytes = bytesAt(position, size_ - position);
  std::string_view rest = bytes;
  for (; connections > 0; --connections) {
    const BagRecord record = BagRecord::take(rest);
    if (record.kind() != BagRecord::kConnection) throw std::runtime_error("its index is damaged");
    connections_.emplace(numberOf<std::uint32_t>(record.header, "conn"), connectionOf(record));
  }
  for (; chunks > 0; --chunks) {
    const BagRecord record = BagRecord::take(rest);
    if (record.kind() != BagRecord::kChunkInfo) throw std::runtime_error("its index is damaged");
    chunks_.push_back(chunkOf(record));
  }
}

void BagFile::read(const BagChunk& chunk, const std::map<std::uint32_t, const BagConnection*>& wanted,
                   ReadChunk& read) {
  const auto lengthAt = [this](std::uint64_t position) {
    std::uint32_t length = 0;
    readInto(position, reinterpret_cast<std::uint8_t*>(&length), sizeof length);
    return length;
  };
  const std::uint32_t header_size = lengthAt(chunk.position);
  const std::uint64_t data_at = chunk.position + sizeof header_size + header_size;
  const std::uint32_t data_size = lengthAt(data_at);
  const std::string header = bytesAt(chunk.position + sizeof header_size, header_size);
  const auto size = numberOf<std::uint32_t>(header, "size");
  if (numberOf<std::uint8_t>(header, "op") != BagRecord::kChunk || size > kMostChunk)
    throw std::runtime_error("a chunk's header is damaged");
  if (size > kUsualChunk + kMostPacked * data_size)
    throw std::runtime_error("a chunk of " + std::to_string(data_size) + " bytes claims to hold " +
                             std::to_string(size) + ", must be at most 255 times as many and 1 MB");
  if (data_size > size_) throw std::runtime_error("a chunk reaches beyond the file's end");
  read.packed.resize(data_size);
  readInto(data_at + sizeof data_size, read.packed.data(), data_size);
  read.bytes.resize(size);
  unpack(packingOf(fieldOf(header, "compression")), read);
  listMessages(wanted, read);
}

void BagFile::unpack(rosbag::CompressionType packing, ReadChunk& read) const {
  const auto size = [](const std::vector<std::uint8_t>& bytes) { return static_cast<unsigned>(bytes.size()); };
  if (packing == rosbag::compression::Uncompressed && size(read.packed) == size(read.bytes))
    return read.packed.swap(read.bytes);
  try {
    streams_.getStream(packing)->decompress(read.bytes.data(), size(read.bytes), read.packed.data(), size(read.packed));
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(error.what());  // BagException would mean an error of an output
  }
}

void BagFile::listMessages(const std::map<std::uint32_t, const BagConnection*>& wanted, ReadChunk& read) {
  read.messages.clear();
  std::string_view rest(reinterpret_cast<const char*>(read.bytes.data()), read.bytes.size());
  while (!rest.empty()) {
    const BagRecord record = BagRecord::take(rest);
    if (record.kind() != BagRecord::kMessage) continue;
    const auto connection = wanted.find(numberOf<std::uint32_t>(record.header, "conn"));
    if (connection == wanted.end()) continue;
    read.messages.push_back({timeIn(record.header, "time"), connection->second,
                             reinterpret_cast<const std::uint8_t*>(record.data.data()),
                             static_cast<std::uint32_t>(record.data.size())});
  }
  const auto earlier = [](const BagMessage& a, const BagMessage& b) { return a.time < b.time; };
  if (!std::is_sorted(read.messages.begin(), read.messages.end(), earlier))
    std::stable_sort(read.messages.begin(), read.messages.end(), earlier);
}

}  // namespace hammer_loads
