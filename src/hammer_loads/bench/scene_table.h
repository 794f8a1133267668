/// Errors that matter for a scene, on machines with an elastic connecting rod: of the mean force that a slow boom
/// feels, of a hull's fatigue and of a blow's energy, by level, with the stated standard deviations.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/estimate_errors.h"

namespace hammer_loads::accuracy {

struct SceneErrors {
  /// Errors of Fx, Fz and the moment: means over 1/60 s, to which a boom below 30 Hz responds, over the largest of the
  /// true ones. Means in which a tool is touched are left out: there the blow's impulse is added.
  std::array<FigureErrors::Result, 3> slow;
  FigureErrors::Result energy, restitution;  ///< errors of blows: energy relative, restitution as a difference [-]
};

/// Errors of one session through the pipeline at a level.
SceneErrors sceneErrors(const Settings& settings, const ElasticKind& kind, Level level);
/// All elasticKinds() at levels rocker, linkage and elastic, with the errors of `elastic`, their rows of that table.
Table sceneTable(const Settings& settings, const std::vector<ElasticRow>& elastic);

}  // namespace hammer_loads::accuracy
