#include "hammer_loads/bench/drawing_table.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::accuracy {
namespace {

/// Hammer drawn from the distribution of the nominal one. Lengths keep the change point.
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

/// The machines that are drawn have rigid rods, and the file states it.
Mechanism withRigidRod(HammerParameters p) {
  p.rod_std = {};
  return *Mechanism::make(p).value;
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
  const Mechanism mechanism = withRigidRod(settings.mechanism.parameters());
  SessionPlayer player(mechanism, settings.pipeline, {}, session);
  DrawingRow row;
  row.seed = seed;
  std::array<double, 3> peak{};
  std::array<FigureErrors, 3> samples;
  FigureErrors energy, impulse, amplitude;
  LifeError life;
  player.playTo(kInfinity, [&](double, const SampleResult& loads) {
    const auto time = [&](std::int64_t stamp) { return 1e-9 * static_cast<double>(stamp - machine.start_stamp); };
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      const auto near = std::find_if(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
        return std::abs(b.time - time(end.stamp)) < 0.05;
      });
      if (near == session.blows.end() || near->time < 3.0) continue;
      life.endTurn();
      energy.addRelative(end.blow.energy, near->strike.energy, end.blow.energy_std);
      if (!end.pulse || !near->whole_turn) continue;
      impulse.addRelative(end.pulse->turn_impulse_z, near->turn_impulse_z, end.pulse_errors.turn_impulse_z.deviation());
      amplitude.addRelative(end.pulse->amplitude, near->turn_peak_force_z, end.pulse_errors.amplitude.deviation());
    }
    if (!loads.isPublished() || time(loads.stamp) < 3.0 || time(loads.stamp) > 13.5) return;
    const auto truth = std::lower_bound(session.truth.begin(), session.truth.end(), time(loads.stamp) - 1e-6,
                                        [](const simulation::CrankTruth& t, double at) { return t.time < at; });
    if (truth == session.truth.end() || std::abs(truth->time - time(loads.stamp)) > 1e-6) return;
    const std::array<double, 3> is{truth->load.force_x, truth->load.force_z,
                                   truth->load.torque_y + truth->drive_reaction_y};
    life.add(loads.wrench.force_z, is[1],
             life::LoadError::of(loads.ofExtreme().deviation.force_z, loads.deviation.common.force_z));
    const Eigen::Vector3d found = vectorOf(loads.wrench), deviation = vectorOf(loads.deviation.wrench);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      peak[k] = std::max(peak[k], std::abs(is[k]));
      samples[k].add(found[i] - is[k], deviation[i]);
    }
  });
  for (std::size_t k = 0; k < 3; ++k) row.samples[k] = samples[k].result(peak[k]);
  row.energy = energy.result();
  row.impulse = impulse.result();
  row.amplitude = amplitude.result();
  const LifeFigure figure = life.figure();
  FigureErrors range;
  range.add(figure.error, std::hypot(figure.own, figure.common));
  row.range = range.result();
  return row;
}

std::vector<DrawingRow> drawingTable(const Settings& settings, int drawings, std::uint64_t first_seed) {
  std::vector<DrawingRow> rows;
  for (int i = 0; i < drawings; ++i)
    rows.push_back(drawingRow(settings, first_seed + static_cast<std::uint64_t>(i), 1.0));
  return rows;
}

std::vector<DrawingSummary> summary(const std::vector<DrawingRow>& rows) {
  std::vector<DrawingSummary> all;
  const auto add = [&](const char* quantity, const auto& figure) {
    DrawingSummary sum{quantity, {}};
    for (const DrawingRow& row : rows) {
      const FigureErrors::Result one = figure(row);
      sum.all.rms += square(one.rms), sum.all.said += square(one.said), sum.all.covered += one.covered;
      sum.least = std::min(sum.least, one.covered);
    }
    const auto count = static_cast<double>(rows.size());
    sum.all = {std::sqrt(sum.all.rms / count), std::sqrt(sum.all.said / count), sum.all.covered / count};
    all.push_back(sum);
  };
  add("Fx, of the peak", [](const DrawingRow& row) { return row.samples[0]; });
  add("Fz, of the peak", [](const DrawingRow& row) { return row.samples[1]; });
  add("moment, of the peak", [](const DrawingRow& row) { return row.samples[2]; });
  add("turn impulse", [](const DrawingRow& row) { return row.impulse; });
  add("peak of Fz", [](const DrawingRow& row) { return row.amplitude; });
  add("blow energy", [](const DrawingRow& row) { return row.energy; });
  add("damage-equivalent range of Fz", [](const DrawingRow& row) { return row.range; });
  return all;
}

std::string markdown(const std::vector<DrawingSummary>& rows) {
  std::string text =
      "| | error, rms | stated, rms | within two standard deviations | smallest of a machine |\n"
      "|---|---|---|---|---|\n";
  for (const DrawingSummary& row : rows)
    text += format("| %s | %.2f %% | %.2f %% | %.0f %% | %.0f %% |\n", row.quantity, 100.0 * row.all.rms,
                   100.0 * row.all.said, 100.0 * row.all.covered, 100.0 * row.least);
  return text;
}

std::string json(const std::vector<DrawingSummary>& rows) {
  std::string text;
  for (const DrawingSummary& row : rows)
    text +=
        format("%s\n    {\"quantity\": \"%s\", \"rms\": %.6g, \"stated\": %.6g, \"covered\": %.6g, \"least\": %.6g}",
               text.empty() ? "" : ",", row.quantity, row.all.rms, row.all.said, row.all.covered, row.least);
  return "[" + text + "\n  ]";
}

}  // namespace hammer_loads::accuracy
