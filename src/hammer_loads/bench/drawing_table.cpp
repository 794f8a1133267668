#include "hammer_loads/bench/drawing_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads::accuracy {
namespace {

/// Of the drawing's hammer, one that it may be. Lengths keep the change point.
HammerParameters drawn(HammerParameters p, std::uint64_t seed, double off) {
  simulation::NormalNoise noise(seed);
  const HammerParameters drawing = p;
  for (int attempt = 0; attempt < 100; ++attempt) {
    p = drawing;
    for (std::size_t i = 0; i < kHammerConstants.size(); ++i)
      kHammerConstants[i].field(p) += off * p.deviations[i] * std::clamp(noise(), -1.9, 3.0);
    p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
    if (Mechanism::make(p).value) return p;
  }
  return drawing;
}

}  // namespace

DrawingRow drawingRow(const Settings& settings, std::uint64_t seed, double off) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.level = Level::kLinkage;
  machine.hammer = drawn(settings.mechanism.parameters(), seed, off);
  machine.duration = 15.0;
  machine.drive.stop_time = 14.0;
  machine.seed = seed;
  machine.crank.drop_outs.clear();
  const simulation::Session session = simulation::recordSession(machine);
  SessionPlayer player(settings.mechanism, settings.pipeline, {}, session);
  DrawingRow row;
  row.seed = seed;
  std::array<double, 3> peak{}, squares{}, said{}, inside{};
  double count = 0.0, blows = 0.0, energy = 0.0;
  player.playTo(kInfinity, [&](double, const SampleResult& loads) {
    const auto time = [&](std::int64_t stamp) { return 1e-9 * static_cast<double>(stamp - machine.start_stamp); };
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      const auto near = std::find_if(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
        return std::abs(b.time - time(end.stamp)) < 0.05;
      });
      if (near == session.blows.end() || near->time < 3.0) continue;
      const double error = end.blow.energy - near->strike.energy;
      ++blows;
      energy += square(error / near->strike.energy);
      row.energy_covered += std::abs(error) <= 2.0 * end.blow.energy_deviation;
    }
    if (loads.refusal || loads.beside_blow || time(loads.stamp) < 3.0 || time(loads.stamp) > 13.5) return;
    const auto truth = std::lower_bound(session.truth.begin(), session.truth.end(), time(loads.stamp) - 1e-6,
                                        [](const simulation::CrankTruth& t, double at) { return t.time < at; });
    if (truth == session.truth.end() || std::abs(truth->time - time(loads.stamp)) > 1e-6) return;
    const std::array<double, 3> is{truth->load.force_x, truth->load.force_z,
                                   truth->load.torque_y + truth->drive_reaction_y};
    const Eigen::Vector3d found = vectorOf(loads.wrench), deviation = vectorOf(loads.deviation.wrench);
    for (std::size_t k = 0; k < 3; ++k) {
      const double error = found[static_cast<Eigen::Index>(k)] - is[k], d = deviation[static_cast<Eigen::Index>(k)];
      peak[k] = std::max(peak[k], std::abs(is[k]));
      squares[k] += square(error);
      said[k] += square(d);
      inside[k] += std::abs(error) <= 2.0 * d;
    }
    ++count;
  });
  for (std::size_t k = 0; k < 3; ++k) {
    row.rms[k] = std::sqrt(squares[k] / count) / peak[k];
    row.said[k] = std::sqrt(said[k] / count) / peak[k];
    row.covered[k] = inside[k] / count;
  }
  row.energy = std::sqrt(energy / blows);
  row.energy_covered /= blows;
  return row;
}

std::vector<DrawingRow> drawingTable(const Settings& settings, int drawings) {
  std::vector<DrawingRow> rows;
  for (int i = 1; i <= drawings; ++i) rows.push_back(drawingRow(settings, static_cast<std::uint64_t>(i), 1.0));
  return rows;
}

std::string markdown(const std::vector<DrawingRow>& rows) {
  std::string text =
      "| drawing | rms Fx | rms Fz | rms moment | said Fx | said Fz | said moment | within two deviations: Fx | Fz | "
      "moment | energy, rms | within |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const DrawingRow& r : rows)
    text += format("| %d | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.0f %% | %.0f %% | %.0f %% | "
                   "%.2f %% | %.0f %% |\n",
                   static_cast<int>(r.seed), 100 * r.rms[0], 100 * r.rms[1], 100 * r.rms[2], 100 * r.said[0],
                   100 * r.said[1], 100 * r.said[2], 100 * r.covered[0], 100 * r.covered[1], 100 * r.covered[2],
                   100 * r.energy, 100 * r.energy_covered);
  return text;
}

}  // namespace hammer_loads::accuracy
