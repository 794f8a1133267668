/// For what is compiled a second time, for a CPU with AVX2 and FMA: which one runs is chosen where it is called.
#pragma once

namespace hammer_loads {

#if defined(__x86_64__) && defined(__GNUC__)
#define HAMMER_LOADS_AVX2 [[gnu::target("avx2,fma")]]
inline const bool kHasAvx2 = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}();
#else
#define HAMMER_LOADS_AVX2
constexpr bool kHasAvx2 = false;
#endif

}  // namespace hammer_loads
