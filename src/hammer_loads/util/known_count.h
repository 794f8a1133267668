/// Loops whose length is known when they are compiled, for the lengths that most machines have.
#pragma once

#include <type_traits>

namespace hammer_loads {

/// f(count), with the count as a constant where it is the usual one: loops of three and four take half of the
/// instructions then.
template <int kUsual, typename F>
inline decltype(auto) withCount(int count, const F& f) {
  if (count == kUsual) return f(std::integral_constant<int, kUsual>());
  return f(count);
}

}  // namespace hammer_loads
