/// The cheapest level of the model that a machine allows.
#pragma once

#include <array>
#include <string>

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {

/// Difference of a level's wrench from that of the most detailed level, divided by the uncertainty of level linkage by
/// the hammer's constants (WrenchColumns): root mean squares over a working turn, the largest of force x, force z and
/// moment [-]. Infinite for a hammer whose constants are exact, unless there is no difference. The most detailed level
/// is elastic, or linkage for a rigid rod.
struct LevelChoice {
  Level level{};  ///< the cheapest within tolerance
  double tolerance{};
  bool rod_is_elastic{};               ///< the rod
  std::array<double, 3> difference{};  ///< relative differences of levels pulse, rocker and linkage
};

/// Simulates one periodic turn at level linkage: the constant net drive torque replaces the energy of the blow, and the
/// speed at the blow is such that the turn takes 1/turn_rate [s]. Weight counts in the wrench, hull vertical; in the
/// turn's motion it is neglected. The part of an elastic rod, with the file's values or else a first guess (RodPrior),
/// is that of one blow that leaves the rocker at its tool (TwoBodies), in means over `interval` [s] > 0. tolerance,
/// turn_rate, g [m/s2] > 0, g may be 0. The crank's acceleration is taken as known; the effect of a simpler level on
/// the estimated drive inertia is neglected.
LevelChoice chooseLevel(const Mechanism& mechanism, double tolerance, double turn_rate, double g,
                        double interval = 1e-3);

/// Message of one line: the chosen level and the reason, with the figures.
std::string describe(const LevelChoice& choice);

}  // namespace hammer_loads
