#include "hammer_loads/bench/drawing_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/bench/life_error.h"
#include "hammer_loads/bench/session_player.h"
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

/// The machines that are drawn have rigid rods, and the file says so.
Mechanism withRigidRod(HammerParameters p) {
  p.rod_deviation = {};
  return *Mechanism::make(p).value;
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

/// The samples' Fz as the life of a machine counts it, for what that says of its ranges' deviation.
life::LifeRecorder forceRecorder() {
  constexpr const char* kForce = "hull_wrench/force_z_N";
  life::LifeSettings settings;
  settings.channels = {{kForce, *life::LoadGrid::make(-2e5, 2e5, 4096).value}};
  settings.period = 1;
  return *life::LifeRecorder::make(settings, {kForce}).value;
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
  std::array<double, 3> peak{}, squares{}, said{}, inside{};
  double count = 0.0;
  FigureErrors energy, impulse, amplitude;
  LifeError life;
  life::LifeRecorder recorder = forceRecorder();
  player.playTo(kInfinity, [&](double, const SampleResult& loads) {
    const auto time = [&](std::int64_t stamp) { return 1e-9 * static_cast<double>(stamp - machine.start_stamp); };
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      const auto near = std::find_if(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
        return std::abs(b.time - time(end.stamp)) < 0.05;
      });
      if (near == session.blows.end() || near->time < 3.0) continue;
      recorder.turn();
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
    life.add(loads.wrench.force_z, is[1]);
    recorder.sample(loads.stamp, &loads.wrench.force_z, &loads.deviation.wrench.force_z,
                    &loads.deviation.common.force_z);
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
  row.range_error = life.error();
  const life::RangeDeviation range = life::rangeDeviation(recorder.take().counts[0]);
  row.range_deviation = std::hypot(range.own, range.common);
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
