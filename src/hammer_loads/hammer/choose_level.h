/// The cheapest level of the model that a machine allows.
#pragma once

#include <array>
#include <string>

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {

/// Largest error of a level's wrench over a working turn, against level linkage: of force along x and z over the
/// largest force, of the moment over the largest moment; the largest of the three [-].
struct LevelChoice {
  Level level{};  ///< the cheapest within tolerance
  double tolerance{};
  std::array<double, 2> error{};  ///< of pulse and of rocker
};

/// Works one turn with the machine at level linkage: constant net drive torque that makes up for the blow, so that each
/// turn is like the one before; the speed at the blow such that the turn takes 1/turn_rate [s]. Weight counts in the
/// wrench, hull vertical; in the turn's motion it is neglected. tolerance, turn_rate, g [m/s2] > 0, g may be 0.
/// The crank's acceleration is taken as known: what a poorer level does to the estimate of the drive inertia is not
/// seen.
LevelChoice chooseLevel(const Mechanism& mechanism, double tolerance, double turn_rate, double g);

/// One line for a person: which and why, with the figures.
std::string describe(const LevelChoice& choice);

}  // namespace hammer_loads
