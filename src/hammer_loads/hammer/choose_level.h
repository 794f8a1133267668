/// The cheapest level of the model that a machine allows.
#pragma once

#include <array>
#include <string>

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {

/// Difference of a level's wrench to that of the richest over what the hammer's constants leave open of level linkage
/// (WrenchColumns): root mean squares over a working turn, the largest of force x, force z and moment [-]. A hammer
/// that is given as exact leaves nothing open: then it is infinite, unless there is no difference. The richest is
/// elastic, unless the rod is given as rigid.
struct LevelChoice {
  Level level{};  ///< the cheapest within tolerance
  double tolerance{};
  bool gives{};                        ///< the rod
  std::array<double, 3> difference{};  ///< relative differences of levels pulse, rocker and linkage
};

/// Works one turn with the machine at level linkage: constant net drive torque that makes up for the blow, so that each
/// turn is like the one before; the speed at the blow such that the turn takes 1/turn_rate [s]. Weight counts in the
/// wrench, hull vertical; in the turn's motion it is neglected. The part of an elastic rod, with the file's values or
/// else a first guess (RodPrior), is that of one blow that leaves the rocker at its tool (TwoBodies), in means over
/// `interval` [s] > 0. tolerance, turn_rate, g [m/s2] > 0, g may be 0. The crank's acceleration is taken as known: what
/// a poorer level does to the estimate of the drive inertia is not seen.
LevelChoice chooseLevel(const Mechanism& mechanism, double tolerance, double turn_rate, double g,
                        double interval = 1e-3);

/// One line for a person: which and why, with the figures.
std::string describe(const LevelChoice& choice);

}  // namespace hammer_loads
