#include "hammer_loads/bench/session_table.h"

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

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
      "| rate, Hz | encoder counts | speed | rms Fx | rms Fz | rms torque | peak, worst turn "
      "| turn "
      "impulse | blow instant | energy |\n|---|---|---|---|---|---|---|---|---|---|\n";
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
        "%s\n  {\"rate_hz\": %g, \"encoder_counts\": %d, \"speed_measured\": %s, \"rms_x\": "
        "%.6g, "
        "\"rms_z\": %.6g, \"rms_torque\": %.6g, \"turn_peak\": %.6g, \"turn_impulse\": %.6g, \"blow_time_s\": %.6g, "
        "\"energy\": %s, \"blows\": %d, \"missed_blows\": %d}",
        &row == rows.data() ? "" : ",", row.rate, row.counts, row.speed ? "true" : "false", e.rms_x, e.rms_z,
        e.rms_torque, e.turn_peak, e.turn_impulse, e.blow_time, energyJson(e).c_str(), e.blows, e.missed_blows);
  }
  return text + "\n]";
}

}  // namespace hammer_loads::accuracy
