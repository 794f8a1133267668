// The counter behind counting_new.h: part of every room's tests.
#include "support/counting_new.h"

#include <cstdlib>

namespace hammer_loads::test {
std::atomic<std::size_t> allocations{0};
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

// Of the sanitizer's runtime library; GCC ships no header for it.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*, std::size_t),
                                                         void (*free_hook)(const volatile void*));

namespace hammer_loads::test {
/// The sanitizer's allocator must stay in charge; it tells of every call.
inline const int counting = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++allocations; }, [](const volatile void*) {});
}  // namespace hammer_loads::test

#else

// glibc's own allocator under its public alternative names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

extern "C" {
void* malloc(std::size_t size) {
  ++hammer_loads::test::allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++hammer_loads::test::allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++hammer_loads::test::allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++hammer_loads::test::allocations;
  return __libc_memalign(alignment, size);
}
}

#endif
