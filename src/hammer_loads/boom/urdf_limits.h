/// Bounds of a robot description's text, checked before it is given to recursive parsers.
#pragma once

#include <cstddef>
#include <string>

namespace hammer_loads {

/// The bounds exceed any machine and are far below what exhausts a thread's stack.
struct UrdfLimits {
  static constexpr std::size_t kBytes = std::size_t{16} << 20;  ///< length of the text
  static constexpr int kDepth = 64;                             ///< tags within tags
  static constexpr int kLinks = 1000;                           ///< links of the robot
  static constexpr int kJoints = 1000;                          ///< joints of the robot
  // Limit: kBytes, kDepth, kLinks, kJoints
};

/// One line when the text passes a limit, naming it, or has a `<` within a tag, where parsers may disagree; else empty.
/// Does not judge anything else: a text that is no XML passes.
std::string urdfLimitPassed(const std::string& text);

}  // namespace hammer_loads
