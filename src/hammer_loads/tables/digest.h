/// Digests of texts, numbers and files: FNV-1a of 64 bit, against mistakes, and SHA-256, also against forgery.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "hammer_loads/util/format.h"

namespace hammer_loads {

/// FNV-1a.
class Digest {
 public:
  explicit Digest(std::uint64_t from = 14695981039346656037ULL) : hash_(from) {}
  template <typename T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 1099511628211ULL;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_;
};

/// FNV-1a in 16 hexadecimal digits.
inline std::string digestOf(const std::string& text) {
  Digest digest;
  for (const char letter : text) digest.add(letter);
  return format("%016llx", static_cast<unsigned long long>(digest.value()));
}

/// SHA-256 of texts in hexadecimal, each with its length, so that different lists have different digests.
std::string sha256Of(const std::vector<std::string>& texts);

/// SHA-256 of the files' bytes in sequence. Throws std::runtime_error if a file cannot be read.
std::string sha256OfFiles(const std::vector<std::string>& files);

}  // namespace hammer_loads
