/// --help and --version of a node, which needs no ROS master for them.
#pragma once

#include <iostream>
#include <optional>
#include <string>

namespace hammer_loads {

/// Exit code where the first argument asks for one of them; nothing: the node may start.
inline std::optional<int> answerUsage(int argc, char** argv, const char* usage) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--version") {
    std::cout << "hammer_loads " HAMMER_LOADS_VERSION << std::endl;
  } else if (first == "--help" || first == "-h") {
    std::cout << usage << std::flush;
  } else {
    return std::nullopt;
  }
  return std::cout ? 0 : 1;
}

}  // namespace hammer_loads
