/// Every way from crank states to loads, behind one face.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hammer_loads/bench/hard_cases.h"
#include "hammer_loads/bench/load_errors.h"

namespace hammer_loads::accuracy {

struct LoadWay {
  std::string group;
  std::string name;
  Level level{};
  Parts parts{};
  /// Loads of all states of a case.
  std::function<std::vector<LinkLoads>(const HardCase&)> loads;
  /// The same computing, ready to run again and again without keeping its results.
  std::function<std::function<void()>(const HardCase&)> pass;
};

/// Batches: as wide as the CPU allows.
std::vector<LoadWay> loadWays();

}  // namespace hammer_loads::accuracy
