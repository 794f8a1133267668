#include "hammer_loads/bench/drawing_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/life/damage.h"
#include "hammer_loads/life/life_recorder.h"
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

/// Of figures of which there is one a turn.
class FigureErrors {
 public:
  void add(double found, double truth, double deviation) {
    ++count_;
    squares_ += square((found - truth) / truth);
    inside_ += std::abs(found - truth) <= 2.0 * deviation;
  }
  DrawingRow::OfTurns result() const { return {std::sqrt(squares_ / count_), inside_ / count_}; }

 private:
  double count_{}, squares_{}, inside_{};
};

/// Load cycles of the samples' Fz, as they are found and as they are.
class RangeErrors {
 public:
  RangeErrors() : found_(recorder()), truth_(recorder()) {}
  void sample(const SampleResult& loads, double truth) {
    const double deviation = loads.deviation.wrench.force_z, common = loads.deviation.common.force_z;
    found_.sample(loads.stamp, &loads.wrench.force_z, &deviation, &common);
    truth_.sample(loads.stamp, &truth, nullptr);
  }
  void turn() { found_.turn(), truth_.turn(); }
  /// Relative error of the damage-equivalent range at a slope of 5 and its relative deviation.
  void finish(DrawingRow& row) {
    const life::CycleCount found = found_.take().counts[0], truth = truth_.take().counts[0];
    const auto range = [](const life::CycleCount& count) {
      return life::equivalentLoad(life::rangesAndMeans(count), 5.0, 1.0, life::rangeDeviation(count));
    };
    const life::Figure is = range(truth), was = range(found);
    row.range_error = was.value / is.value - 1.0;
    row.range_deviation = was.deviation / was.value;
  }

 private:
  static life::LifeRecorder recorder() {
    life::LifeSettings settings;
    settings.channels = {{kForce, *life::LoadGrid::make(-2e5, 2e5, 4096).value}};
    settings.period = 1000LL * 1000 * 1000 * 1000;
    settings.equivalent_cycles_per_hour = 1.0;
    return *life::LifeRecorder::make(settings, {kForce}).value;
  }
  static constexpr const char* kForce = "hull_wrench/force_z_N";
  life::LifeRecorder found_, truth_;
};

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
  double count = 0.0;
  FigureErrors energy, impulse, amplitude;
  RangeErrors ranges;
  player.playTo(kInfinity, [&](double, const SampleResult& loads) {
    const auto time = [&](std::int64_t stamp) { return 1e-9 * static_cast<double>(stamp - machine.start_stamp); };
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      const auto near = std::find_if(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
        return std::abs(b.time - time(end.stamp)) < 0.05;
      });
      if (near == session.blows.end() || near->time < 3.0) continue;
      ranges.turn();
      energy.add(end.blow.energy, near->strike.energy, end.blow.energy_deviation);
      if (!end.pulse || !near->whole_turn) continue;
      impulse.add(end.pulse->turn_impulse_z, near->turn_impulse_z, end.pulse_errors.turn_impulse_z.deviation());
      amplitude.add(end.pulse->amplitude, near->turn_peak_force_z, end.pulse_errors.amplitude.deviation());
    }
    if (loads.refusal || loads.beside_blow || time(loads.stamp) < 3.0 || time(loads.stamp) > 13.5) return;
    const auto truth = std::lower_bound(session.truth.begin(), session.truth.end(), time(loads.stamp) - 1e-6,
                                        [](const simulation::CrankTruth& t, double at) { return t.time < at; });
    if (truth == session.truth.end() || std::abs(truth->time - time(loads.stamp)) > 1e-6) return;
    const std::array<double, 3> is{truth->load.force_x, truth->load.force_z,
                                   truth->load.torque_y + truth->drive_reaction_y};
    ranges.sample(loads, is[1]);
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
  row.energy = energy.result();
  row.impulse = impulse.result();
  row.amplitude = amplitude.result();
  ranges.finish(row);
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
      "moment | energy, rms | within | impulse, rms | within | peak, rms | within | equivalent range, error | said |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  const auto percent = [&](double part, int places) { text += format(" %.*f %% |", places, 100.0 * part); };
  for (const DrawingRow& r : rows) {
    text += format("| %d |", static_cast<int>(r.seed));
    for (const double rms : r.rms) percent(rms, 2);
    for (const double said : r.said) percent(said, 2);
    for (const double covered : r.covered) percent(covered, 0);
    for (const DrawingRow::OfTurns& figure : {r.energy, r.impulse, r.amplitude})
      percent(figure.rms, 2), percent(figure.covered, 0);
    percent(r.range_error, 2), percent(r.range_deviation, 2);
    text += '\n';
  }
  return text;
}

}  // namespace hammer_loads::accuracy
