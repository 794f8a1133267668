#include "hammer_loads/bench/boom_table.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

constexpr unsigned kPoses = 8;
constexpr double kAway = 0.06;                         // [rad]
constexpr double kJudgedFrom = 6.0, kJudgedTo = 10.0;  // [s]

using Change = void (*)(simulation::MachineSettings&);
struct BoomKind {
  const char* name;
  double oil;              // over the boom file's
  double hold_down_force;  // on rock [N]; 0: the hull hangs
  double drive;            // speed of the operator's motion [rad/s]
  Change change;           // flaw added to a machine with clean sensors and a boom without flaws; null: none
};

/// Friction as measured on a loader crane (doc/boom_calibration.md).
void rub(simulation::MachineSettings& m) {
  std::mt19937 random(static_cast<unsigned>(m.seed));
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  m.on_boom.seals.constant = between(0.010, 0.016);
  m.on_boom.seals.friction = between(0.03, 0.06);
  m.on_boom.seals.presliding = between(2e-5, 1e-4);
}

void wear(simulation::MachineSettings& m) {
  rub(m);
  m.on_boom.bending_frequency = 30.0;
  m.on_boom.air = 0.008;
  m.on_boom.pin_play = 1.2e-4;
  m.on_boom.leak = 1e-13;
}

void waitForBus(simulation::MachineSettings& m) {
  m.on_boom.pressures.hose_lag = 5e-3, m.on_boom.pressures.rate = 100.0, m.on_boom.pressures.count = 39e3;
  m.on_boom.bus_delay = 1e-3;
  m.joint_rate = 100.0, m.joint_count = kTwoPi / 4096.0;
}

/// Stamps of an odometry of 10 Hz, scaled to 100 Hz (config/simulated_machine.yaml).
void stampAsDrivers(simulation::MachineSettings& m) { m.boom_stamps = {1.08e-3, 5e-4, 8e-3}; }

constexpr BoomKind kBoomKinds[] = {{"oil as in the file", 1.0, 0.0, 0.0, nullptr},
                                   {"bulk modulus 30 % lower", 0.7, 0.0, 0.0, nullptr},
                                   {"bulk modulus 40 % higher", 1.4, 0.0, 0.0, nullptr},
                                   {"bulk modulus 40 % higher, crank typical", 1.4, 0.0, 0.0, makeTypical},
                                   {"boom driven with 0.15 rad/s", 1.0, 0.0, 0.15, nullptr},
                                   {"hull pressed on rock with 4 kN", 1.0, 4000.0, 0.0, nullptr},
                                   {"pressed on rock, crank typical", 1.0, 4000.0, 0.0, makeTypical},
                                   {"seals that rub", 1.0, 0.0, 0.0, rub},
                                   {"seals that rub, pressed on rock", 1.0, 4000.0, 0.0, rub},
                                   {"worn boom", 1.0, 0.0, 0.0, wear},
                                   {"worn boom, pressed on rock", 1.0, 4000.0, 0.0, wear},
                                   {"sensors over a bus", 1.0, 0.0, 0.0, waitForBus},
                                   {"sensors over a bus, pressed on rock", 1.0, 4000.0, 0.0, waitForBus},
                                   {"stamps of real drivers", 1.0, 0.0, 0.0, stampAsDrivers}};

struct Way {
  const char* name;
  const char* keys;
  SensorsOnBoom sensors;
};
constexpr Way kWays[] = {
    {"none", "{boom: compliant, hull_motion: model}", {false, false}},
    {"IMU", "{boom: compliant, boom_stiffness: identified, hull_motion: imu}", {true, false}},
    {"pressures", "{boom: compliant, boom_stiffness: identified, hull_motion: model}", {false, true}},
    {"both", "{boom: compliant, boom_stiffness: identified, hull_motion: imu}", {true, true}}};

/// Within the limits of the joints, wherever they move.
simulation::MachineSettings machineOf(const BoomKind& kind, unsigned pose, const Chain& chain) {
  simulation::MachineSettings m = machineOnBoom(kJudgedTo);
  m.seed = 40 + pose;
  m.on_boom.oil_stiffness = kind.oil;
  if (kind.change != nullptr) kind.change(m);
  if (kind.hold_down_force > 0.0) m.on_boom.rock = {3e7, 3.0, kind.hold_down_force};
  std::mt19937 random(pose);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  m.boom[1].mean = between(-0.9, 0.1), m.boom[2].mean = between(0.5, 1.9);
  m.boom[3].mean = between(-0.4, 0.4) - m.boom[1].mean - m.boom[2].mean;
  if (kind.drive > 0.0) m.boom[1].period = 6.0, m.boom[1].amplitude = kind.drive * m.boom[1].period / kTwoPi;
  for (int joint = 1; joint <= 3; ++joint) {
    simulation::JointMotion& motion = m.boom[static_cast<std::size_t>(joint)];
    const double away = std::max(kAway, motion.amplitude);
    motion.mean = std::clamp(motion.mean, chain.lower()[joint] + away, chain.upper()[joint] - away);
  }
  return m;
}

void takeWorse(const LifeError& e, LifeFigure& worst) {
  const LifeFigure figure = e.figure();
  if (std::abs(figure.error) > std::abs(worst.error)) worst = figure;
}

void takeWorst(const BoomErrors& e, BoomRow& row) {
  row.torque = std::max(row.torque, e.worstTorque());
  row.section = std::max(row.section, e.worstSection());
  row.moment = std::max(row.moment, e.moment.rms());
  row.force_z = std::max(row.force_z, e.force_z.rmsOfLargest());
  row.worst_z = std::max(row.worst_z, e.force_z.worstOfLargest());
  row.force_x = std::max(row.force_x, e.force_x.rmsOfLargest());
  row.force = std::max(row.force, e.rmsForce());
  row.worst_force = std::max(row.worst_force, e.worstForce());
  row.covered_wrench = std::min(row.covered_wrench, e.leastWrenchCovered());
  row.energy = std::max(row.energy, std::abs(e.energy()));
  row.contact = std::max(row.contact, e.contact.rmsOfRange());
  if (e.withheld < e.samples) row.covered = std::min(row.covered, e.covered());
  row.samples += e.samples, row.withheld += e.withheld;
  takeWorse(e.life_force_z, row.life_force);
  for (const LifeError& joint : e.life_torque) takeWorse(joint, row.life_torque);
  for (const LifeError& cut : e.life_section) takeWorse(cut, row.life_section);
}

std::string percent(double part, const char* unknown = "withheld") {
  return std::isfinite(part) ? format("%.1f %%", 100.0 * part) : unknown;
}

}  // namespace

std::vector<BoomRow> boomTable() {
  std::vector<BoomRow> rows;
  const Settings shipped = shippedBoom("{}");
  for (const BoomKind& kind : kBoomKinds) {
    std::vector<simulation::Session> sessions;
    for (unsigned pose = 1; pose <= kPoses; ++pose)
      sessions.push_back(simulation::recordSession(machineOf(kind, pose, shipped.boom->chain())));
    for (const Way& way : kWays) {
      const Settings settings = shippedBoom(way.keys);
      BoomRow row{kind.name, way.name};
      for (const simulation::Session& session : sessions)
        takeWorst(boomErrors(session, settings.mechanism, settings.pipeline, *settings.boom, way.sensors, kJudgedFrom,
                             kJudgedTo),
                  row);
      if (row.withheld == row.samples) {
        row.torque = row.section = row.covered = row.contact = kNaN;
        row.life_torque = row.life_section = {kNaN, kNaN, kNaN};
      }
      if (!(kind.hold_down_force > 0.0) || !way.sensors.pressures) row.contact = kNaN;
      rows.push_back(row);
    }
  }
  return rows;
}

std::string markdown(const std::vector<BoomRow>& rows) {
  std::string text =
      "| machine | sensors | joint torques | bending | hull moment | Fx | Fz | worst sample of Fz | force | worst "
      "sample of the force | energy | rock's force | torques withheld | torques within two standard deviations | "
      "smallest of Fx, Fz, moment within two standard deviations "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const BoomRow& r : rows) {
    text += format("| %s | %s |", r.machine.c_str(), r.sensors.c_str());
    for (const double part :
         {r.torque, r.section, r.moment, r.force_x, r.force_z, r.worst_z, r.force, r.worst_force, r.energy})
      text += ' ' + percent(part) + " |";
    text += ' ' + percent(r.contact, "not known") + format(" | %.0f %% | ", 100.0 * r.withheldPart()) +
            (std::isfinite(r.covered) ? format("%.0f %%", 100.0 * r.covered) : "withheld") +
            format(" | %.0f %% |\n", 100.0 * r.covered_wrench);
  }
  return text;
}

std::string json(const std::vector<BoomRow>& rows) {
  std::string text = "[";
  for (const BoomRow& r : rows)
    text += format(
        "%s\n  {\"machine\": \"%s\", \"sensors\": \"%s\", \"torque\": %s, \"section\": %s, \"moment\": %.4g, "
        "\"rms_z\": %.4g, \"worst_z\": %.4g, \"energy\": %.4g, \"contact\": %s, \"covered_torque\": %s, "
        "\"withheld_torque\": %.4g, \"rms_x\": "
        "%.4g, \"rms_force\": %.4g, \"worst_force\": %.4g, \"covered_wrench\": %.4g, \"life_force\": %s, "
        "\"life_torque\": %s, \"life_section\": %s}",
        &r == rows.data() ? "" : ",", r.machine.c_str(), r.sensors.c_str(), jsonNumber(r.torque).c_str(),
        jsonNumber(r.section).c_str(), r.moment, r.force_z, r.worst_z, r.energy, jsonNumber(r.contact).c_str(),
        jsonNumber(r.covered).c_str(), r.withheldPart(), r.force_x, r.force, r.worst_force, r.covered_wrench,
        json(r.life_force).c_str(), json(r.life_torque).c_str(), json(r.life_section).c_str());
  return text + "\n]";
}

}  // namespace hammer_loads::accuracy
