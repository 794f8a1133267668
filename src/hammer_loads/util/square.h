/// For formulas: the square of what needs no name of its own.
#pragma once

namespace hammer_loads {

constexpr double square(double x) noexcept { return x * x; }

}  // namespace hammer_loads
