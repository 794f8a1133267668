#include "hammer_loads/bench/session_run.h"

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

SessionErrors judgeBy(const std::vector<simulation::CrankTruth>& at, const SessionRun& run,
                      const simulation::Session& session, const simulation::MachineSettings& machine) {
  std::vector<WrenchAt> truth;
  for (const simulation::CrankTruth& t : at) {
    const Eigen::Vector3d wrench = wrenchOf(t);
    truth.push_back({t.time, wrench[0], wrench[1], wrench[2]});
  }
  std::vector<BlowAt> blows;
  for (const simulation::BlowTruth& b : session.blows)
    blows.push_back({b.time, b.strike.energy, b.strike.tool_impulse, b.turn_peak_force_z, b.turn_impulse_z});
  Judged judged{3.0, machine.duration - 3.0, {}};
  for (const auto& gap : machine.crank.drop_outs) judged.drop_outs.push_back(gap.to);
  return sessionErrors(run.wrenches, truth, run.blows, blows, judged);
}

struct CrankSensorKind {
  double rate;  ///< rate of crank samples [Hz]
  int counts;   ///< counts of the encoder per revolution
  bool speed;   ///< speeds are measured too
};

simulation::MachineSettings machineOf(const Settings& settings, const CrankSensorKind& kind) {
  simulation::MachineSettings machine = simulation::workingMo100();
  const double drive_inertia = machine.drive.inertia;
  machine.hammer = settings.mechanism.parameters();
  machine.level = settings.pipeline.level;
  machine.drive.inertia = drive_inertia;
  machine.duration = 15.0;
  machine.drive.stop_time = 13.5;
  machine.crank.rate = kind.rate;
  machine.crank.counts = kind.counts;
  machine.crank.speed = kind.speed;
  return machine;
}

SessionErrors errorsOf(const Settings& settings, const CrankSensorKind& kind) {
  const simulation::MachineSettings machine = machineOf(settings, kind);
  const simulation::Session session = simulation::recordSession(machine);
  PipelineSettings pipeline = settings.pipeline;
  pipeline.crank_angle_resolution = kTwoPi / kind.counts;
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
    const HullWrench stated = loads.outputs.empty() ? HullWrench{} : loads.outputs.front().deviation.wrench();
    run.wrenches.push_back({seconds(loads.stamp), loads.wrench.force_x, loads.wrench.force_z, loads.wrench.torque_y,
                            stated.force_x, stated.force_z, stated.torque_y});
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

Table sessionTable(const Settings& settings) {
  std::vector<CrankSensorKind> kinds;
  for (const double rate : {2000.0, 1000.0, 500.0, 200.0, 100.0, 50.0, 20.0}) kinds.push_back({rate, 4096, true});
  for (const int counts : {512, 1024, 2048, 8192, 65536}) kinds.push_back({1000.0, counts, true});
  for (const double rate : {1000.0, 100.0}) kinds.push_back({rate, 4096, false});
  Table table(6);
  for (const CrankSensorKind& kind : kinds) {
    const SessionErrors e = errorsOf(settings, kind);
    table.beginRow();
    table.cell("rate, Hz", format("%.0f", kind.rate)), table.number("rate_hz", kind.rate);
    table.cell("encoder counts", std::to_string(kind.counts)), table.number("encoder_counts", kind.counts);
    table.cell("speed", kind.speed ? "measured" : "none"), table.field("speed_measured", kind.speed ? "true" : "false");
    table.percent("rms Fx", "rms_x", 2, e.x.rms);
    table.percent("rms Fz", "rms_z", 2, e.z.rms);
    table.percent("rms torque", "rms_torque", 2, e.torque.rms);
    table.percent("peak, worst turn", "turn_peak", 2, e.turn_peak);
    table.percent("turn impulse", "turn_impulse", 2, e.turn_impulse);
    table.cell("blow instant", format("%.3f ms", 1e3 * e.blow_time)), table.number("blow_time_s", e.blow_time);
    table.cell("energy", energyCell(e, 2)), table.number("energy", e.energy);
    table.number("blows", e.blows), table.number("missed_blows", e.missed_blows);
  }
  return table;
}

}  // namespace hammer_loads::accuracy
