/// Limit of heap fragmentation in a process that logs for days.
#pragma once

#include <malloc.h>

namespace hammer_loads {

/// Returns large blocks to the system when they are freed. Call it first in a program's main; a library must not change
/// the heap of its process. By default glibc keeps freed blocks up to the size of the largest one freed so far. The
/// buffers that grow with every bag then lie among small blocks and fragment the heap over hours (doc/reliability.md,
/// log soak).
inline void keepMemorySteady() noexcept {
  constexpr int kLargeBlock = 128 * 1024;  // glibc's own initial value [byte]
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
}

}  // namespace hammer_loads
