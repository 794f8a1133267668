/// Cost table, fourth part: section loads on the shipped boom, by what sensors there are.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hammer_loads/bench/estimate_errors.h"

namespace hammer_loads::accuracy {

/// Errors as parts of one: root mean squares over those of the truth, of sections and the rock's force over its range,
/// of Fz over its peak. Each the worst of the poses, of the samples that are published.
struct BoomRow {
  std::string machine, sensors;
  double torque{};   ///< error of the worst joint, without weight
  double section{};  ///< bending at the cut that is worst
  double moment{};   ///< torque about D
  double force_x{}, force_z{}, worst_z{};
  double force{}, worst_force{};      ///< error as a vector: root mean square and worst sample, over the largest force
  double covered_wrench{1.0};         ///< smallest part of force x, force z and moment within two standard deviations
  double energy{};                    ///< mean of the blows
  double contact{};                   ///< error of the rock's force; NaN without rock or pressures
  double covered{1.0};                ///< torques within two deviations, the least
  std::size_t samples{}, withheld{};  ///< published in all poses, without joint torques among them

  double withheldPart() const { return static_cast<double>(withheld) / static_cast<double>(samples); }
  /// Errors of the damage-equivalent range at slope kLifeSlope, > 0 too large: hull force z, torque of the worst joint
  /// with weight, bending at the worst cut.
  LifeFigure life_force{}, life_torque{}, life_section{};
};

/// The simulated EO-2621 on its oil with the shipped boom file, which may be wrong of the oil; poses drawn, the same on
/// every run. A quarter of a minute of computing.
std::vector<BoomRow> boomTable();

std::string markdown(const std::vector<BoomRow>& rows);
std::string json(const std::vector<BoomRow>& rows);

}  // namespace hammer_loads::accuracy
