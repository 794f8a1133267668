/// Counts heap allocations of the whole test program: malloc and everything built on it (operator new, Eigen).
#pragma once

#include <atomic>
#include <cstddef>

namespace hammer_loads::test {
extern std::atomic<std::size_t> allocations;  // in counting_new.cpp
}
