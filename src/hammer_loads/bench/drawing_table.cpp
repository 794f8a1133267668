#include "hammer_loads/bench/drawing_table.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::accuracy {
namespace {

/// Hammer drawn from the distribution of the nominal one. Lengths keep the change point.
HammerParameters drawn(HammerParameters p, std::uint64_t seed) {
  simulation::NormalNoise noise(seed);
  const HammerParameters drawing = p;
  for (int attempt = 0; attempt < 100; ++attempt) {
    p = drawing;
    for (std::size_t i = 0; i < kHammerConstants.size(); ++i)
      kHammerConstants[i].field(p) += p.deviations[i] * std::clamp(noise(), -1.9, 3.0);
    p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
    if (Mechanism::make(p).value) return p;
  }
  return drawing;
}

}  // namespace

DrawingRow drawingRow(const Settings& settings, std::uint64_t seed) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.level = Level::kLinkage;
  machine.hammer = drawn(settings.mechanism.parameters(), seed);
  machine.duration = 15.0;
  machine.drive.stop_time = 14.0;
  machine.seed = seed;
  machine.crank.drop_outs.clear();
  const simulation::Session session = simulation::recordSession(machine);
  HammerParameters file = settings.mechanism.parameters();
  file.rod_std = {};  // the machines that are drawn have rigid rods
  SessionPlayer player(*Mechanism::make(file).value, settings.pipeline, {}, session);
  DrawingRow row;
  std::array<double, 3> peak{};
  std::array<FigureErrors, 3> samples;
  FigureErrors energy, impulse, amplitude;
  LifeError life;
  player.playTo(kInfinity, [&](double, const SampleResult& loads) {
    const auto time = [&](std::int64_t stamp) { return seconds(stamp - machine.start_stamp); };
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
    const Eigen::Vector3d is = wrenchOf(*truth);
    life.add(loads.wrench.force_z, is[1],
             life::LoadError::of(loads.ofExtreme().deviation.force_z, loads.deviation.common().force_z));
    const Eigen::Vector3d found = vectorOf(loads.wrench), deviation = vectorOf(loads.deviation.wrench());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      peak[k] = std::max(peak[k], std::abs(is[i]));
      samples[k].add(found[i] - is[i], deviation[i]);
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

Table drawingTable(const Settings& settings, int drawings, std::uint64_t first_seed) {
  std::vector<DrawingRow> rows;
  for (int i = 0; i < drawings; ++i) rows.push_back(drawingRow(settings, first_seed + static_cast<std::uint64_t>(i)));
  Table table(6);
  const auto add = [&](const char* quantity, const auto& figure) {
    DrawingRow::Figure sum;
    double least = 1.0;
    for (const DrawingRow& row : rows) {
      const DrawingRow::Figure one = figure(row);
      sum.rms += square(one.rms), sum.stated += square(one.stated), sum.covered += one.covered;
      least = std::min(least, one.covered);
    }
    const auto count = static_cast<double>(rows.size());
    table.beginRow();
    table.text("", "quantity", quantity);
    table.percent("error, rms", "rms", 2, std::sqrt(sum.rms / count));
    table.percent("stated, rms", "stated", 2, std::sqrt(sum.stated / count));
    table.percent("within two standard deviations", "covered", 0, sum.covered / count);
    table.percent("smallest of a machine", "least", 0, least);
  };
  add("Fx, of the peak", [](const DrawingRow& row) { return row.samples[0]; });
  add("Fz, of the peak", [](const DrawingRow& row) { return row.samples[1]; });
  add("moment, of the peak", [](const DrawingRow& row) { return row.samples[2]; });
  add("turn impulse", [](const DrawingRow& row) { return row.impulse; });
  add("peak of Fz", [](const DrawingRow& row) { return row.amplitude; });
  add("blow energy", [](const DrawingRow& row) { return row.energy; });
  add("damage-equivalent range of Fz", [](const DrawingRow& row) { return row.range; });
  return table;
}

}  // namespace hammer_loads::accuracy
