#include "hammer_loads/bench/machine_table.h"

#include <functional>
#include <regex>

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/pipeline/filter_settings.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

using simulation::MachineSettings;

struct Kind {
  std::string name;
  std::vector<double> rates;  ///< [Hz]
  std::function<void(MachineSettings&)> flaw;
  double inertia_guess{1.0};  ///< over the true one
  bool calibrated{};
  double shift{};  ///< mean of all stamps less the instants, beside half a tick of the driver's clock [s]
  CrankStamps stamps{CrankStamps::kAuto};
};

std::vector<Kind> kinds() {
  const auto jitter = [](double deviation) {
    return [deviation](MachineSettings& s) { s.crank.stamp_noise = deviation; };
  };
  const auto loss = [](double part) { return [part](MachineSettings& s) { s.blow.crank_loss = part; }; };
  const auto counts = [](int number) { return [number](MachineSettings& s) { s.crank.counts = number; }; };
  const auto zero_off = [](MachineSettings& s) { s.crank.zero = 0.5 * kDegree; };
  const auto eccentric = [](MachineSettings& s) { s.crank.eccentricity[0] = {1.0 * kDegree, 1.0}; };
  const auto coupled = [](MachineSettings& s) {
    s.drive.coupling_frequency = 50.0, s.drive.motor_share = 0.2, s.drive.coupling_damping = 0.02;
  };
  return {
      {"clean", {1000.0, 200.0, 100.0}, [](MachineSettings&) {}},
      {"typical", {1000.0, 200.0}, makeTypical, 1.3},
      {"typical, after calibrate", {1000.0, 200.0}, makeTypical, 1.3, true},
      {"stamps jitter by 0.05 ms", {1000.0, 100.0}, jitter(5e-5)},
      {"stamps jitter by 0.2 ms", {1000.0, 100.0}, jitter(2e-4)},
      {"stamps jitter by 1 ms", {1000.0, 200.0}, jitter(1e-3)},
      {"stamps of whole ms", {1000.0}, [](MachineSettings& s) { s.crank.stamp_step = 1e-3; }, 1.0, false, -0.5e-3},
      {"bursts of ten", {1000.0}, [](MachineSettings& s) { s.crank.burst = 10; }},
      {"bursts of ten, no speeds",
       {1000.0, 200.0},
       [](MachineSettings& s) { s.crank.burst = 10, s.crank.speed = false; }},
      {"restitution 0 to 0.3",
       {1000.0, 100.0},
       [](MachineSettings& s) { s.blow.restitution_drawn = true, s.blow.restitution_high = 0.3; }},
      {"crank loses 20 % at the blow", {1000.0, 100.0}, loss(0.2)},
      {"crank loses 45 % at the blow", {1000.0, 100.0}, loss(0.45)},
      {"tool met 0.3 deg early", {1000.0, 100.0}, [](MachineSettings& s) { s.blow.tool_early = 0.3 * kDegree; }},
      {"blank firing in 10 % of the revolutions",
       {1000.0, 100.0},
       [](MachineSettings& s) { s.blow.blank_share = 0.1; }},
      {"zero 0.5 deg off", {1000.0, 100.0}, zero_off},
      {"the same, after calibrate", {1000.0, 100.0}, zero_off, 1.0, true},
      {"encoder eccentric by 1 deg", {1000.0, 100.0}, eccentric},
      {"eccentric, after calibrate", {1000.0, 100.0}, eccentric, 1.0, true},
      {"360 counts", {1000.0, 100.0}, counts(360)},
      {"1024 counts", {1000.0, 100.0}, counts(1024)},
      {"coupling of 50 Hz, taken for rigid", {1000.0, 100.0}, coupled},
      {"no speeds", {1000.0, 100.0}, [](MachineSettings& s) { s.crank.speed = false; }},
  };
}

/// Machines whose sensor is filtered by a drive, moves, or has a coarse clock. Stamps that jitter keep their order, so
/// that they are used as they are.
std::vector<Kind> sensorKinds() {
  const auto held = [](double jitter, double lag, double scale) {
    return [=](MachineSettings& s) {
      s.crank.stamp_noise = jitter, s.crank.stamps_ordered = jitter > 0.0;
      s.crank.speed_lag = lag, s.crank.speed_scale = scale;
    };
  };
  const auto mute = [](double jitter) {
    return
        [=](MachineSettings& s) { s.crank.stamp_noise = jitter, s.crank.stamps_ordered = true, s.crank.speed = false; };
  };
  const auto slip = [](double degrees, double to) {
    return [=](MachineSettings& s) { s.crank.slip = {degrees * kDegree, {8.0, to}}; };
  };
  Kind lossy{"jitter of 1 ms, given as steady, 0.2 % lost", {1000.0, 200.0}, [](MachineSettings& s) {
               s.crank.stamp_noise = 1e-3, s.crank.loss_share = 0.002;
             }};
  lossy.stamps = CrankStamps::kSteady;
  const auto polled = [](double late_share, double late_mean) {
    return [=](MachineSettings& s) { s.crank.driver = {0.108 / s.crank.rate, late_share, late_mean}; };
  };
  return {
      {"stamps of a real driver", {1000.0}, polled(5e-4, 8e-4)},
      {"the same, 1 % late by 4 ms", {1000.0, 200.0}, polled(0.01, 4e-3)},
      {"stamps jitter by 0.57 ms, as those", {1000.0}, [](MachineSettings& s) { s.crank.stamp_noise = 5.7e-4; }},
      {"jitter of 0.3 ms in order", {1000.0, 200.0}, mute(3e-4)},
      {"the same, speeds lag by 2 ms", {1000.0, 200.0}, held(3e-4, 2e-3, 1.0)},
      {"the same, speeds lag by 20 ms", {1000.0, 200.0}, held(3e-4, 2e-2, 1.0)},
      {"the same, speeds 5 % too large", {1000.0, 200.0}, held(3e-4, 0.0, 1.05)},
      {"jitter of 1 ms in order", {1000.0, 200.0}, mute(1e-3)},
      {"the same, speeds lag by 10 ms", {1000.0, 200.0}, held(1e-3, 1e-2, 1.0)},
      {"jitter of 1 ms in order, speeds lag by 20 ms", {1000.0, 200.0}, held(1e-3, 2e-2, 1.0)},
      {"zero slips by 2 deg", {1000.0, 200.0}, slip(2.0, simulation::kNever)},
      {"index lost for 4 s: 1 deg off", {1000.0}, slip(1.0, 12.0)},
      {"angle lags by 2 ms", {1000.0, 200.0}, [](MachineSettings& s) { s.crank.angle_lag = 2e-3; }},
      lossy,
  };
}

MachineSettings machineOf(const Settings& settings, const Kind& kind, double rate, std::uint64_t seed) {
  MachineSettings machine = simulation::workingMo100();
  machine.hammer = settings.mechanism.parameters();
  machine.level = settings.pipeline.level;
  machine.duration = kind.calibrated ? 40.0 : 20.0;
  machine.drive.stop_time = machine.duration - 2.0;
  machine.crank.rate = rate;
  machine.seed = seed;
  kind.flaw(machine);
  return machine;
}

/// Applies the result of `calibrate` for the recording; each key only where it is determined.
void applyCalibration(const simulation::Session& session, const MachineSettings& machine, HammerParameters& hammer,
                      PipelineSettings& pipeline) {
  std::vector<calibration::RecordedSample> samples;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankReading& reading = session.crank[i];
    const double pitch = session.truth[i].hull_pitch;
    samples.push_back({1e-9 * static_cast<double>(reading.stamp - machine.start_stamp),
                       reading.angle,
                       reading.speed,
                       {machine.gravity * std::sin(pitch), -machine.gravity * std::cos(pitch)}});
  }
  const Mechanism mechanism = *Mechanism::make(hammer).value;
  const calibration::CalibrationBasis basis{mechanism, pipeline.level, filterSettings(mechanism, pipeline)};
  CrankSensorPlace place;
  for (const calibration::Estimate& e : calibration::calibrate(samples, basis).estimates) {
    if (!e.determined()) continue;
    if (e.key == "crank_zero_rad") place.zero = e.value, pipeline.crank_zero_std = e.deviation;
    if (e.key == "crank_direction") place.direction = static_cast<int>(e.value);
    if (e.key == "crank_eccentricity_1_rad") place.eccentricity[0] = e.value;
    if (e.key == "crank_eccentricity_1_phase_rad") place.eccentricity_phase[0] = e.value;
    if (e.key == "crank_eccentricity_2_rad") place.eccentricity[1] = e.value;
    if (e.key == "crank_eccentricity_2_phase_rad") place.eccentricity_phase[1] = e.value;
    if (e.key == "crank_timing_noise_s") pipeline.crank_timing_noise = e.value;
    if (e.key == "drive_inertia_kg_m2") hammer.drive_inertia = e.value;
  }
  pipeline.crank_sensor = *CrankSensor::make(place).value;
}

SessionErrors errorsOn(const Settings& settings, const Kind& kind, const MachineSettings& machine) {
  const simulation::Session session = simulation::recordSession(machine);
  HammerParameters hammer = settings.mechanism.parameters();
  hammer.drive_inertia = kind.inertia_guess * machine.drive.inertia;
  PipelineSettings pipeline = settings.pipeline;
  pipeline.crank_stamps = kind.stamps;
  if (kind.calibrated) applyCalibration(session, machine, hammer, pipeline);
  const SessionRun run = runSession(session, machine.start_stamp, *Mechanism::make(hammer).value, pipeline);
  return judgeAtStamps(run, session, machine, kind.shift + 0.5 * machine.crank.driver.tick);
}

void addRow(const Kind& kind, const simulation::CrankSensorSettings& crank, const SessionErrors& e, Table& table) {
  table.beginRow();
  table.text("machine", "machine", kind.name);
  table.cell("rate, Hz", format("%.0f", crank.rate)), table.number("rate_hz", crank.rate);
  table.cell("speed", crank.speed ? "measured" : "none"), table.field("speed_measured", crank.speed ? "true" : "false");
  const std::string blows = std::to_string(e.blows), missed = std::to_string(e.unseen_blows);
  if (std::isnan(e.rms_force)) {
    table.field("withheld", "true");
    for (const std::string& text : {std::string("withheld"), {}, {}, {}, {}, blows, missed, {}}) table.cell({}, text);
    return;
  }
  table.percents("rms force, Fx, Fz, moment", 2,
                 {{"rms_force", e.rms_force}, {"rms_x", e.x.rms}, {"rms_z", e.z.rms}, {"rms_torque", e.torque.rms}});
  table.percents("worst sample of each", 1,
                 {{"worst_force", e.worst_force},
                  {"worst_x", e.x.worst},
                  {"worst_z", e.z.worst},
                  {"worst_torque", e.torque.worst}});
  table.percents("within two standard deviations: Fx, Fz, moment", 0,
                 {{"covered_x", e.x.covered}, {"covered_z", e.z.covered}, {"covered_torque", e.torque.covered}});
  table.cell("blow instant", format("%.2f ms", 1e3 * e.blow_time)), table.number("blow_time_s", e.blow_time);
  table.cell("energy", energyCell(e, 1)), table.number("energy", e.energy);
  table.cell("blows", blows), table.number("blows", e.blows);
  table.cell("missed", missed), table.number("missed_blows", e.unseen_blows);
  table.cell("false", std::to_string(e.false_blows)), table.number("false_blows", e.false_blows);
}

}  // namespace

void makeTypical(MachineSettings& s) {
  s.crank.counts = 1024;
  s.crank.zero = 0.5 * kDegree;
  s.crank.eccentricity[0] = {0.2 * kDegree, 1.0};
  s.crank.stamp_noise = 3e-4;
  s.crank.speed = false;
  s.blow.restitution_drawn = true;
  s.blow.restitution_low = 0.1;
  s.blow.restitution_high = 0.25;
}

bool MachineChoice::has(const std::string& name) const {
  return rows.empty() || std::regex_search(name, std::regex(rows));
}

Table machineTable(const Settings& settings, const MachineChoice& choice) {
  Table table(6);
  for (const std::vector<Kind>& all : {kinds(), sensorKinds()}) {
    for (const Kind& kind : all) {
      for (const double rate : kind.rates) {
        if (!choice.has(kind.name + format(" %.0f", rate))) continue;
        MachineSettings machine = machineOf(settings, kind, rate, choice.seed);
        if (!choice.speeds && !machine.crank.speed) continue;
        machine.crank.speed = machine.crank.speed && choice.speeds;
        addRow(kind, machine.crank, errorsOn(settings, kind, machine), table);
      }
    }
  }
  return table;
}

}  // namespace hammer_loads::accuracy
