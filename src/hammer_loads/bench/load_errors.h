/// Errors of computed loads against the reference.
#pragma once

#include <vector>

#include "hammer_loads/bench/hard_cases.h"
#include "hammer_loads/bench/newton_euler.h"
#include "hammer_loads/hammer/link_loads.h"

namespace hammer_loads::accuracy {

/// Worst over states and loads; infinite where a load is no number.
struct Error {
  double of_peak{};   ///< of the largest size that the load has in the whole turn and in the case's own states
  double relative{};  ///< of the load's own size, forces as vectors; moments, which pass through zero: of the peak
};

/// Which loads a way gives.
enum class Parts {
  kForceZ,   ///< of the hull wrench
  kWrench,   ///< hull wrench
  kPins,     ///< hull wrench, four pin forces, drive torque
  kPrinted,  ///< the same without drive torque
};

/// A case at a level, worked out by the reference.
struct ExactCase {
  ExactCase(const HardCase& hard_case, Level level);
  std::vector<Reference> states;  ///< one per angle
  std::vector<Reference> turn;    ///< evenly spaced, for the peaks
};

Error errorOf(const std::vector<LinkLoads>& computed, const ExactCase& exact, Parts parts);

}  // namespace hammer_loads::accuracy
