#include "hammer_loads/bench/boom_table.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/util/constants.h"

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

void addRow(const BoomKind& kind, const Way& way, const std::vector<BoomErrors>& poses, BoomTable& to) {
  std::size_t samples = 0, withheld = 0;
  double covered = 1.0, covered_wrench = 1.0;
  BoomLife life{kind.name, way.name, {}, {}, {}};
  for (const BoomErrors& e : poses) {
    samples += e.samples, withheld += e.withheld;
    if (e.withheld < e.samples) covered = std::min(covered, e.covered());
    covered_wrench = std::min(covered_wrench, e.leastWrenchCovered());
    takeWorse(e.life_force_z, life.force);
    for (const LifeError& joint : e.life_torque) takeWorse(joint, life.torque);
    for (const LifeError& cut : e.life_section) takeWorse(cut, life.section);
  }
  const bool known = withheld<samples, on_rock = kind.hold_down_force> 0.0;
  if (!known) life.torque = life.section = {kNaN, kNaN, kNaN};
  const auto worst = [&](const auto& figure) {
    double most = 0.0;
    for (const BoomErrors& e : poses) most = std::max(most, figure(e));
    return most;
  };
  const auto worstIf = [&](bool is_known, const auto& figure) { return is_known ? worst(figure) : kNaN; };
  using Errors = const BoomErrors&;
  Table& table = to.errors;
  table.beginRow();
  table.text("machine", "machine", kind.name);
  table.text("sensors", "sensors", way.name);
  table.percent("joint torques", "torque", 1, worstIf(known, [](Errors e) { return e.worstTorque(); }));
  table.percent("bending", "section", 1, worstIf(known, [](Errors e) { return e.worstSection(); }));
  table.percent("hull moment", "moment", 1, worst([](Errors e) { return e.moment.rms(); }));
  table.percent("Fx", "rms_x", 1, worst([](Errors e) { return e.force_x.rmsOfLargest(); }));
  table.percent("Fz", "rms_z", 1, worst([](Errors e) { return e.force_z.rmsOfLargest(); }));
  table.percent("worst sample of Fz", "worst_z", 1, worst([](Errors e) { return e.force_z.worstOfLargest(); }));
  table.percent("force", "rms_force", 1, worst([](Errors e) { return e.rmsForce(); }));
  table.percent("worst sample of the force", "worst_force", 1, worst([](Errors e) { return e.worstForce(); }));
  table.percent("energy", "energy", 1, worst([](Errors e) { return std::abs(e.energy()); }));
  table.percent("rock's force", "contact", 1,
                worstIf(known && on_rock && way.sensors.pressures, [](Errors e) { return e.contact.rmsOfRange(); }),
                "not known");
  table.percent("torques withheld", "withheld_torque", 0, static_cast<double>(withheld) / static_cast<double>(samples));
  table.percent("torques within two standard deviations", "covered_torque", 0, known ? covered : kNaN);
  table.percent("smallest of Fx, Fz, moment within two standard deviations", "covered_wrench", 0, covered_wrench);
  table.field("life_force", json(life.force));
  table.field("life_torque", json(life.torque));
  table.field("life_section", json(life.section));
  to.life.push_back(life);
}

}  // namespace

BoomTable boomTable() {
  BoomTable table{Table(4), {}};
  const Settings shipped = shippedBoom("{}");
  for (const BoomKind& kind : kBoomKinds) {
    std::vector<simulation::Session> sessions;
    for (unsigned pose = 1; pose <= kPoses; ++pose)
      sessions.push_back(simulation::recordSession(machineOf(kind, pose, shipped.boom->chain())));
    for (const Way& way : kWays) {
      const Settings settings = shippedBoom(way.keys);
      std::vector<BoomErrors> poses;
      for (const simulation::Session& session : sessions)
        poses.push_back(boomErrors(session, settings, way.sensors, kJudgedFrom, kJudgedTo));
      addRow(kind, way, poses, table);
    }
  }
  return table;
}

}  // namespace hammer_loads::accuracy
