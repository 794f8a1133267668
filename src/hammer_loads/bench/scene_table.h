/// Errors that matter for a scene, on machines with an elastic connecting rod: of the mean force that a slow boom
/// feels, of a hull's fatigue and of a blow's energy, by level, with the stated standard deviations.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/estimate_errors.h"

namespace hammer_loads::accuracy {

struct SceneRow {
  std::string machine;
  Level level{};
  /// Errors of Fx, Fz and the moment: means over 1/60 s, to which a boom below 30 Hz responds, over the largest of the
  /// true ones. Means in which a tool is touched are left out: there the blow's impulse is added.
  std::array<FigureErrors::Result, 3> slow;
  LifeFigure life;                           ///< error of Fz's damage-equivalent range, see ElasticErrors
  FigureErrors::Result energy, restitution;  ///< errors of blows: energy relative, restitution as a difference [-]
  double energy_bias{}, restitution_bias{};  ///< mean errors
};

/// Row of one session through the pipeline at a level.
SceneRow sceneRow(const Settings& settings, const ElasticKind& kind, Level level);
/// Rows of all elasticKinds() at levels rocker, linkage and elastic; `elastic`: their rows of that table.
std::vector<SceneRow> sceneTable(const Settings& settings, const std::vector<ElasticRow>& elastic);

/// Rows as a table in Markdown.
std::string markdown(const std::vector<SceneRow>& rows);
/// Rows as a JSON array of objects, errors as parts of one.
std::string json(const std::vector<SceneRow>& rows);

}  // namespace hammer_loads::accuracy
