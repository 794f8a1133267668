/// A simulated session through the pipeline, judged by its truth; cost table, second part: error of a whole session by
/// sample rate and encoder.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/table.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::accuracy {

/// Wrench of a sample [N, N, N m], time since the session's start [s]; of an estimate with its deviation.
struct WrenchAt {
  double time{}, force_x{}, force_z{}, torque_y{};
  double force_x_std{}, force_z_std{}, torque_y_std{};
};

/// A blow and the pulse of the turn before it, as estimated or true; turn_* are NaN without a pulse.
struct BlowAt {
  double time{}, energy{}, tool_impulse{};
  double turn_peak{std::numeric_limits<double>::quiet_NaN()};
  double turn_impulse_z{std::numeric_limits<double>::quiet_NaN()};
  double energy_std{}, tool_impulse_std{};  ///< standard deviations of an estimate
};

/// Largest or root-mean-square errors; of the peak of each quantity where nothing else is said.
struct SessionErrors {
  FigureErrors::Result x, z, torque;
  double rms_force{}, worst_force{};  ///< errors of the force as a vector, over its largest magnitude
  double turn_peak{};                 ///< relative, worst turn
  double turn_impulse{};              ///< error over the blow's tool impulse, worst turn
  double blow_time{};                 ///< [s], worst
  /// Relative, worst of those that are known; NaN where none is.
  double energy{std::numeric_limits<double>::quiet_NaN()};
  int known_energies{};
  int blows{}, missed_blows{}, extra_blows{};  ///< missed: without pulse as well
  int unseen_blows{}, false_blows{};           ///< nothing near them; nothing there
};

/// The judged time: [from, to], without the two turns after each drop-out.
struct Judged {
  double from{}, to{};
  std::vector<double> drop_outs;  ///< ends of drop-outs [s]
  double two_turns{0.5};          ///< [s]
  bool operator()(double time) const {
    return time >= from && time <= to && std::none_of(drop_outs.begin(), drop_outs.end(), [&](double end) {
             return time > end - 0.15 && time < end + two_turns;
           });
  }
};

inline SessionErrors sessionErrors(const std::vector<WrenchAt>& estimate, const std::vector<WrenchAt>& truth,
                                   const std::vector<BlowAt>& blows, const std::vector<BlowAt>& true_blows,
                                   const Judged& judged) {
  SessionErrors e;
  FigureErrors x, z, torque;
  double peak_x = 0, peak_z = 0, peak_torque = 0, peak_force = 0;
  std::size_t next = 0;
  for (const WrenchAt& t : truth) {
    while (next < estimate.size() && estimate[next].time < t.time - 1e-5) ++next;
    if (!judged(t.time)) continue;
    peak_x = std::max(peak_x, std::abs(t.force_x));
    peak_z = std::max(peak_z, std::abs(t.force_z));
    peak_torque = std::max(peak_torque, std::abs(t.torque_y));
    peak_force = std::max(peak_force, std::hypot(t.force_x, t.force_z));
    if (next == estimate.size() || std::abs(estimate[next].time - t.time) > 1e-5) continue;  // withheld
    const WrenchAt& w = estimate[next];
    x.add(w.force_x - t.force_x, w.force_x_std);
    z.add(w.force_z - t.force_z, w.force_z_std);
    torque.add(w.torque_y - t.torque_y, w.torque_y_std);
    e.worst_force = std::max(e.worst_force, std::hypot(w.force_x - t.force_x, w.force_z - t.force_z));
  }
  e.x = x.result(peak_x), e.z = z.result(peak_z), e.torque = torque.result(peak_torque);
  e.rms_force = std::sqrt((x.squares() + z.squares()) / x.count()) / peak_force;
  e.worst_force /= peak_force;
  for (const BlowAt& t : true_blows) {
    if (!judged(t.time)) continue;
    ++e.blows;
    const auto nearest = std::min_element(blows.begin(), blows.end(), [&](const BlowAt& a, const BlowAt& b) {
      return std::abs(a.time - t.time) < std::abs(b.time - t.time);
    });
    const bool unseen = nearest == blows.end() || std::abs(nearest->time - t.time) > 0.05;
    e.unseen_blows += unseen;
    if (unseen || std::isnan(nearest->turn_peak)) {
      ++e.missed_blows;
      continue;
    }
    e.blow_time = std::max(e.blow_time, std::abs(nearest->time - t.time));
    e.energy = std::fmax(e.energy, std::abs(nearest->energy / t.energy - 1.0));  // no heed to what is no number
    e.known_energies += !std::isnan(nearest->energy);
    e.turn_peak = std::max(e.turn_peak, std::abs(nearest->turn_peak / t.turn_peak - 1.0));
    e.turn_impulse = std::max(e.turn_impulse, std::abs(nearest->turn_impulse_z - t.turn_impulse_z) / t.tool_impulse);
  }
  const auto within = [&](const BlowAt& b) { return judged(b.time); };
  const auto isFalse = [&](const BlowAt& b) {
    const auto isNear = [&](const BlowAt& t) { return std::abs(t.time - b.time) <= 0.05; };
    return within(b) && std::none_of(true_blows.begin(), true_blows.end(), isNear);
  };
  e.false_blows = static_cast<int>(std::count_if(blows.begin(), blows.end(), isFalse));
  e.extra_blows = static_cast<int>(std::count_if(blows.begin(), blows.end(), within)) - e.blows;
  return e;
}

struct SessionRun {
  std::vector<WrenchAt> wrenches;  ///< at the stamps they are published with
  std::vector<double> accepted;    ///< stamps of these and of the samples withheld beside the blow [s]
  std::vector<BlowAt> blows;
  SampleCounts counts;
};

/// Reads a session into a pipeline, joint states in their place between the crank samples. start: stamp of t = 0 [ns].
SessionRun runSession(const simulation::Session& session, std::int64_t start, const Mechanism& mechanism,
                      const PipelineSettings& settings);

/// The blows' energy as a table's cell.
std::string energyCell(const SessionErrors& errors, int digits);

/// Judged from 3 s after the start to 3 s before the end, without the two turns after each drop-out.
SessionErrors judge(const SessionRun& run, const simulation::Session& session,
                    const simulation::MachineSettings& machine);

/// Judges by the truth at the published stamps, for sessions whose stamps are refitted. shift: of all stamps against
/// the instants, which no sequence shows [s].
SessionErrors judgeAtStamps(const SessionRun& run, const simulation::Session& session,
                            const simulation::MachineSettings& machine, double shift);

/// Errors by sample rate and encoder: simulated working sessions of the given hammer (seeded: the same on every run),
/// some 20 s of computing.
Table sessionTable(const Settings& settings);

}  // namespace hammer_loads::accuracy
