/// Result of building a value that cannot exist in an invalid state.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hammer_loads {

/// Either a valid value or every reason why there is none; notes are accepted peculiarities worth telling.
template <typename T>
struct Checked {
  std::optional<T> value;
  std::vector<std::string> problems;  ///< one line each: key, value, unit, violated rule
  std::vector<std::string> notes;     ///< one line each
};

}  // namespace hammer_loads
