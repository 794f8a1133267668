#include "hammer_loads/bench/session_run.h"

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
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

simulation::MachineSettings machineOf(const Settings& settings, const SessionRow& row) {
  simulation::MachineSettings machine = simulation::workingMo100();
  const double drive_inertia = machine.drive.inertia;
  machine.hammer = settings.mechanism.parameters();
  machine.level = settings.pipeline.level;
  machine.drive.inertia = drive_inertia;
  machine.duration = 15.0;
  machine.drive.stop_time = 13.5;
  machine.crank.rate = row.rate;
  machine.crank.counts = row.counts;
  machine.crank.speed = row.speed;
  return machine;
}

SessionErrors errorsOf(const Settings& settings, const SessionRow& row) {
  const simulation::MachineSettings machine = machineOf(settings, row);
  const simulation::Session session = simulation::recordSession(machine);
  PipelineSettings pipeline = settings.pipeline;
  pipeline.crank_angle_resolution = kTwoPi / row.counts;
  return judge(runSession(session, machine.start_stamp, settings.mechanism, pipeline), session, machine);
}

}  // namespace

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

std::vector<SessionRow> sessionTable(const Settings& settings) {
  std::vector<SessionRow> rows;
  for (const double rate : {2000.0, 1000.0, 500.0, 200.0, 100.0, 50.0, 20.0}) rows.push_back({rate, 4096, true, {}});
  for (const int counts : {512, 1024, 2048, 8192, 65536}) rows.push_back({1000.0, counts, true, {}});
  for (const double rate : {1000.0, 100.0}) rows.push_back({rate, 4096, false, {}});
  for (SessionRow& row : rows) row.errors = errorsOf(settings, row);
  return rows;
}

std::string markdown(const std::vector<SessionRow>& rows) {
  std::string text =
      "| rate, Hz | encoder counts | speed | rms Fx | rms Fz | rms torque | peak, worst turn | turn impulse | blow "
      "instant | energy |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SessionRow& row : rows) {
    const SessionErrors& e = row.errors;
    text += format("| %.0f | %d | %s | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.3f ms | %s |\n", row.rate,
                   row.counts, row.speed ? "measured" : "none", 100 * e.rms_x, 100 * e.rms_z, 100 * e.rms_torque,
                   100 * e.turn_peak, 100 * e.turn_impulse, 1e3 * e.blow_time, energyCell(e, 2).c_str());
  }
  return text;
}

std::string json(const std::vector<SessionRow>& rows) {
  std::string text = "[";
  for (const SessionRow& row : rows) {
    const SessionErrors& e = row.errors;
    text += format(
        "%s\n  {\"rate_hz\": %g, \"encoder_counts\": %d, \"speed_measured\": %s, \"rms_x\": %.6g, \"rms_z\": %.6g, "
        "\"rms_torque\": %.6g, \"turn_peak\": %.6g, \"turn_impulse\": %.6g, \"blow_time_s\": %.6g, \"energy\": %s, "
        "\"blows\": %d, \"missed_blows\": %d}",
        &row == rows.data() ? "" : ",", row.rate, row.counts, row.speed ? "true" : "false", e.rms_x, e.rms_z,
        e.rms_torque, e.turn_peak, e.turn_impulse, e.blow_time, energyJson(e).c_str(), e.blows, e.missed_blows);
  }
  return text + "\n]";
}

}  // namespace hammer_loads::accuracy
