/// Switch for scripts/ablate: leaves one mechanism out in a build of its own, and does not exist in any other build.
#pragma once

#ifdef HAMMER_LOADS_ABLATION
#include <cstdlib>
#include <string>

namespace hammer_loads {

/// Returns true if HAMMER_LOADS_ABLATE of the environment, names separated by commas, contains this name.
inline bool isAblated(const char* name) {
  const char* const names = std::getenv("HAMMER_LOADS_ABLATE");
  return names != nullptr && (',' + std::string(names) + ',').find(',' + std::string(name) + ',') != std::string::npos;
}

}  // namespace hammer_loads

/// True while the mechanism of this name is switched off.
#define HAMMER_LOADS_ABLATE(name)                                    \
  ([]() noexcept {                                                   \
    static const bool is_ablated = ::hammer_loads::isAblated(#name); \
    return is_ablated;                                               \
  }())
#else
#define HAMMER_LOADS_ABLATE(name) false
#endif
