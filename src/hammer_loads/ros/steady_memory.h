/// Keeps the memory of a process that logs all day from creeping.
#pragma once

#include <malloc.h>

namespace hammer_loads {

/// For a program's main, first of all; a library has no say in its process's heap. Large blocks go back to the system
/// when they are freed. By default glibc keeps blocks as large as the largest one freed so far: the buffers that grow
/// with every bag then lie among small blocks, and holes come with the hours (doc/reliability.md, log soak).
inline void keepMemorySteady() noexcept {
  constexpr int kLargeBlock = 128 * 1024;  // glibc's own initial value [byte]
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
}

}  // namespace hammer_loads
