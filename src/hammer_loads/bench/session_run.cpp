#include "hammer_loads/bench/session_run.h"

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {

SessionRun runSession(const simulation::Session& session, std::int64_t start, const Mechanism& mechanism,
                      const PipelineSettings& settings) {
  SessionPlayer player(mechanism, settings, {}, session);
  const auto seconds = [start](std::int64_t stamp) { return 1e-9 * static_cast<double>(stamp - start); };
  SessionRun run;
  player.playTo(kInfinity, [&](double, const SampleResult& loads) {
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      BlowAt blow{seconds(end.stamp), end.blow.energy, end.blow.tool_impulse_z};
      blow.energy_std = end.blow.energy_std;
      blow.tool_impulse_std = end.blow_errors.tool_impulse_z.deviation();
      if (end.pulse) {
        blow.turn_peak = end.pulse->amplitude;
        blow.turn_impulse_z = end.pulse->turn_impulse_z;
      }
      run.blows.push_back(blow);
    }
    if (loads.refusal) return;
    run.accepted.push_back(seconds(loads.stamp));
    if (!loads.isPublished()) return;
    const HullDeviation said = loads.outputs.empty() ? HullDeviation{} : loads.outputs.front().deviation;
    run.wrenches.push_back({seconds(loads.stamp), loads.wrench.force_x, loads.wrench.force_z, loads.wrench.torque_y,
                            said.wrench.force_x, said.wrench.force_z, said.wrench.torque_y});
  });
  run.counts = player.pipeline.counts();
  return run;
}

std::string energyCell(const SessionErrors& e, int digits) {
  if (e.known_energies == 0) return "not known";
  const std::string worst = format("%.*f %%", digits, 100 * e.energy);
  const int seen = e.blows - e.missed_blows;
  return e.known_energies == seen ? worst : worst + format(", %d of %d known", e.known_energies, seen);
}

std::string energyJson(const SessionErrors& e) {
  return e.known_energies == 0 ? std::string("null") : format("%.6g", e.energy);
}

namespace {

SessionErrors judgeBy(const std::vector<simulation::CrankTruth>& at, const SessionRun& run,
                      const simulation::Session& session, const simulation::MachineSettings& machine) {
  std::vector<WrenchAt> truth;
  for (const simulation::CrankTruth& t : at)
    truth.push_back({t.time, t.load.force_x, t.load.force_z, t.load.torque_y + t.drive_reaction_y});
  std::vector<BlowAt> blows;
  for (const simulation::BlowTruth& b : session.blows)
    blows.push_back({b.time, b.strike.energy, b.strike.tool_impulse, b.turn_peak_force_z, b.turn_impulse_z});
  Judged judged{3.0, machine.duration - 3.0, {}};
  for (const auto& gap : machine.crank.drop_outs) judged.drop_outs.push_back(gap.to);
  return sessionErrors(run.wrenches, truth, run.blows, blows, judged);
}

}  // namespace

SessionErrors judge(const SessionRun& run, const simulation::Session& session,
                    const simulation::MachineSettings& machine) {
  return judgeBy(session.truth, run, session, machine);
}

SessionErrors judgeAtStamps(const SessionRun& run, const simulation::Session& session,
                            const simulation::MachineSettings& machine, double shift) {
  SessionRun shifted = run;
  std::vector<double> times;
  for (WrenchAt& w : shifted.wrenches) times.push_back(w.time -= shift);
  for (BlowAt& b : shifted.blows) b.time -= shift;
  return judgeBy(simulation::truthAt(machine, times), shifted, session, machine);
}

}  // namespace hammer_loads::accuracy
