/// FNV-1a, 64 bit: tells texts and numbers apart, not forgeries.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "hammer_loads/util/format.h"

namespace hammer_loads {

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

/// 16 hexadecimal digits.
inline std::string digestOf(const std::string& text) {
  Digest digest;
  for (const char letter : text) digest.add(letter);
  return format("%016llx", static_cast<unsigned long long>(digest.value()));
}

}  // namespace hammer_loads
