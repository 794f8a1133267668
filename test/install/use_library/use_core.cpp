/// Links the mechanism's library alone.
#include <iostream>

#include "hammer_loads/linkage/crank_rocker.h"

int main() {
  const auto rocker = hammer_loads::CrankRocker::make({});
  std::cout << rocker.problems.size() << " problems\n";
  return rocker.value ? 1 : 0;  // lengths of 0 are no linkage
}
