/// Cost table, fourth part: section loads on the shipped boom, by what sensors there are.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/table.h"

namespace hammer_loads::accuracy {

/// Errors of the damage-equivalent range at slope kLifeSlope, > 0 too large: hull force z, torque of the worst joint
/// with weight, bending at the worst cut; NaN where all torques are withheld.
struct BoomLife {
  std::string machine, sensors;
  LifeFigure force, torque, section;
};

/// Errors as parts of one: root mean squares over those of the truth, of sections and the rock's force over its range,
/// of Fz over its peak. Each the worst of the poses, of the samples that are published.
struct BoomTable {
  Table errors;
  std::vector<BoomLife> life;
};

/// The simulated EO-2621 on its oil with the shipped boom file, which may be wrong of the oil; poses drawn, the same on
/// every run. A quarter of a minute of computing.
BoomTable boomTable();

}  // namespace hammer_loads::accuracy
