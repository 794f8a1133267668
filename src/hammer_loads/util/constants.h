#pragma once

namespace hammer_loads {

constexpr double kTwoPi = 6.283185307179586232;  ///< 2.4e-16 less than 2 pi

}  // namespace hammer_loads
