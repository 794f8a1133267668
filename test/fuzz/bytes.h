/// Shared by the fuzz targets: numbers from an input's bytes, and a check that ends the program.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace hammer_loads::test {

/// Reads numbers from bytes; bytes missing at the end count as zeros.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return size_ == 0; }
  template <typename T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof(T), size_);
    std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

inline void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace hammer_loads::test
