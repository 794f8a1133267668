/// Cost table, fifth part: errors on machines with an elastic rod and a lasting blow, by level; and one of these blows
/// as a picture shows it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::accuracy {

/// Errors of Fx, Fz and the moment in one part of the revolution.
struct PartErrors {
  std::array<double, 3> rms{};      ///< root mean square of the errors, over `scale` [-]
  std::array<double, 3> covered{};  ///< part of the errors within two of their deviations [-]
  std::array<double, 3> scale{};    ///< [N, N, N m]
  int count{};                      ///< number of samples
};

struct ElasticErrors {
  PartErrors whole;   ///< over the largest of the truth
  PartErrors strike;  ///< crank from 180 to 360 deg; as above
  PartErrors after;   ///< 6 to 40 ms after the first touch; over the root mean square of the truth there
  /// Errors of Fz's damage-equivalent range, without and with the samples in which the rocker touches tool or retainer;
  /// their impulse belongs to the blow and not to the wrench.
  LifeFigure life, life_with_touch;
  double withheld{};  ///< part of the samples without a wrench, those beside the blow among them [-]
};

struct ElasticRow {
  std::string machine;
  Level level{};
  ElasticErrors errors;
};

/// Since the last blow's first touch [s]; infinite before the first.
double sinceBlow(const std::vector<simulation::BlowTruth>& blows, double time);

/// A machine of the elastic rows.
struct ElasticKind {
  std::string name;
  simulation::MachineSettings machine;
};

/// The given hammer with crank and rod as it has them, 1 kHz, 4096 counts and speeds unless the name states otherwise.
std::vector<ElasticKind> elasticKinds(const HammerParameters& hammer, std::uint64_t seed = MachineChoice::kSeed);
/// Errors of one session through the pipeline at a level (seeded: equal on every run).
ElasticErrors elasticErrors(const Settings& settings, const ElasticKind& kind, Level level);
/// Every machine at levels rocker, linkage and elastic, some twenty seconds of computing.
std::vector<ElasticRow> elasticTable(const Settings& settings, const MachineChoice& choice = {});

Table tableOf(const std::vector<ElasticRow>& rows);

/// Force z around the first blow once the rod is known, from 5 ms before it to 45 ms after it, true and by level, as a
/// JSON object.
std::string blowTrace(const Settings& settings);

}  // namespace hammer_loads::accuracy
