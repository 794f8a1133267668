/// What a scene needs: on machines whose rod gives, how far each level is off in what a slow boom, a hull's fatigue and
/// a blow's energy are judged by, and what it says of that.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/figure_errors.h"

namespace hammer_loads::accuracy {

struct SceneRow {
  std::string machine;
  Level level{};
  /// Of Fx, Fz and the moment: means over 1/60 s, which is what a boom below 30 Hz feels of them, over the largest of
  /// the true ones. Those in which a tool is touched are left out: there the blow's impulse is added.
  std::array<FigureErrors::Result, 3> slow;
  LifeFigure life;                           ///< as in ElasticErrors
  FigureErrors::Result energy, restitution;  ///< of blows: energy relative, restitution as a difference [-]
  double energy_bias{}, restitution_bias{};  ///< mean errors
};

/// Of one session through the pipeline at a level.
SceneRow sceneRow(const Settings& settings, const ElasticKind& kind, Level level);
/// Of all elasticKinds() at levels rocker, linkage and elastic; `elastic`: their rows of that table.
std::vector<SceneRow> sceneTable(const Settings& settings, const std::vector<ElasticRow>& elastic);

/// As a table in Markdown.
std::string markdown(const std::vector<SceneRow>& rows);
/// As a JSON array of objects, errors as parts of one.
std::string json(const std::vector<SceneRow>& rows);

}  // namespace hammer_loads::accuracy
