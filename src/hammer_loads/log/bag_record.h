/// Records of a bag: a header of named fields, then data.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hammer_loads {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";  ///< first bytes of a bag

/// Returns the number in the first bytes. Bags are little-endian, as is every machine on which ROS runs.
template <typename T>
T numberIn(std::string_view bytes) {
  if (bytes.size() < sizeof(T)) throw std::runtime_error("a field or record is cut short");
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

template <typename T>
std::string bytesOf(T number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

inline std::string bytesOf(const ros::Time& time) { return bytesOf(time.sec) + bytesOf(time.nsec); }

/// Returns the number of bytes followed by the bytes.
inline std::string pieceOf(const std::string& bytes) {
  return bytesOf(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

/// Removes a length and that many bytes from the beginning of `bytes`; returns the latter.
inline std::string_view takePiece(std::string_view& bytes) {
  const auto size = numberIn<std::uint32_t>(bytes);
  bytes.remove_prefix(sizeof size);
  if (size > bytes.size()) throw std::runtime_error("a record reaches beyond the end");
  const std::string_view piece = bytes.substr(0, size);
  bytes.remove_prefix(size);
  return piece;
}

/// Returns the value of a field; empty if there is none.
inline std::string_view fieldOf(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::string_view field = takePiece(header);
    if (field.size() > name.size() && field[name.size()] == '=' && field.compare(0, name.size(), name) == 0)
      return field.substr(name.size() + 1);
  }
  return {};
}

template <typename T>
T numberOf(std::string_view header, std::string_view name) {
  return numberIn<T>(fieldOf(header, name));
}

inline ros::Time timeIn(std::string_view header, std::string_view name) {
  const std::string_view field = fieldOf(header, name);
  return {numberIn<std::uint32_t>(field), numberIn<std::uint32_t>(field.substr(sizeof(std::uint32_t)))};
}

struct BagRecord {
  enum Kind : std::uint8_t { kMessage = 2, kBag = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

  std::string_view header, data;

  Kind kind() const { return static_cast<Kind>(numberOf<std::uint8_t>(header, "op")); }
  /// Removes a record from the beginning of `bytes` and returns it.
  static BagRecord take(std::string_view& bytes) {
    const std::string_view header = takePiece(bytes);
    return {header, takePiece(bytes)};
  }
};

}  // namespace hammer_loads
