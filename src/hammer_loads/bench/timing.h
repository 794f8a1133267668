/// The cost of a call, with care: processor time of this thread, warm-up, many repeats, their median.
#pragma once

#include <cstddef>
#include <functional>

namespace hammer_loads::accuracy {

struct Cost {
  double median{};  ///< of all repeats, per evaluation [ns]
  double spread{};  ///< distance of the quartiles over the median [-]
};

constexpr double kLeastRepeat = 2e6;  ///< a repeat lasts at least this long [ns of processor time]
constexpr double kTogether = 1.5e8;   ///< all repeats of a long pass, unless their least number takes longer [ns]
constexpr int kMostRepeats = 25, kLeastRepeats = 7;
constexpr int kWarmUps = 3;  ///< repeats before the first that counts

/// A pass makes `evaluations` of them; a repeat makes as many passes as its length needs.
Cost costOf(std::size_t evaluations, const std::function<void()>& pass);

/// Takes the value's address, so that a compiler must compute and store it.
template <typename T>
void keep(const T& value) noexcept {
#if defined(__GNUC__)
  asm volatile("" : : "r"(&value) : "memory");
#else
  static const volatile void* sink;
  sink = &value;
#endif
}

}  // namespace hammer_loads::accuracy
