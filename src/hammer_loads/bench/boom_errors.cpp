#include "hammer_loads/bench/boom_errors.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kSameBlow = 0.005;    // [s]
constexpr double kLeastContact = 1.0;  // [N]

}  // namespace

Settings shippedBoom(const std::string& keys) {
  const std::string shipped = configDirectory();
  std::vector<std::string> problems;
  ParameterMap given;
  addFiles({shipped + "/boom_eo2621.yaml"}, given, problems);
  merge(*parameterMap(YAML::Load(keys), "", problems), given);
  std::ostringstream urdf;
  urdf << std::ifstream(shipped + "/../urdf/eo2621_mo100.urdf").rdbuf();
  Checked<Settings> settings = load(shipped, given, urdf.str());
  problems.insert(problems.end(), settings.problems.begin(), settings.problems.end());
  if (!problems.empty() || !settings.value->boom) throw std::runtime_error("shipped boom: " + problems.front());
  settings.value->pipeline.level = Level::kRocker;  // crank and rod of the simulated machine on a boom are massless
  return *std::move(settings.value);
}

simulation::MachineSettings machineOnBoom(double duration) {
  simulation::MachineSettings m = simulation::workingMo100();
  m.hammer.drive_reaction_ratio = 1.0;
  m.duration = duration;
  m.drive.stop_time = duration + 1.0;
  m.joint_rate = 50.0;
  m.joint_noise = 1e-4;
  m.on_boom.on = true;
  m.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
  m.on_boom.pressures = {500.0, 2e4, 6e6};
  return m;
}

void BoomErrors::addBlows(const simulation::Session& session, const SampleResult& result) {
  for (std::size_t k = 0; k < result.turn_ends; ++k) {
    life_force_z.endTurn();
    for (LifeError* each : {life_torque, life_section}) std::for_each_n(each, 3, [](LifeError& l) { l.endTurn(); });
    const double time = seconds(result.ends[k].stamp - simulation::workingMo100().start_stamp);
    for (const simulation::BlowTruth& blow : session.blows) {
      if (std::abs(blow.time - time) > kSameBlow) continue;
      energy_sum += result.ends[k].blow.energy / blow.strike.energy - 1.0;
      ++blows;
    }
  }
}

void BoomErrors::addWrench(const simulation::OnBoomTruth& truth, const SampleResult& result) {
  largest_force = std::max(largest_force, std::hypot(truth.load.force_x, truth.load.force_z));
  const double x = result.wrench.force_x - truth.load.force_x, z = result.wrench.force_z - truth.load.force_z;
  const double torque_y = result.wrench.torque_y - truth.load.torque_y - truth.drive_reaction_y;
  worst_force = std::max(worst_force, std::hypot(x, z));
  const HullWrench deviation =
      result.outputs.empty() ? HullWrench{kNaN, kNaN, kNaN} : result.outputs.back().deviation.wrench();
  wrench[0].add(x, deviation.force_x);
  wrench[1].add(z, deviation.force_z);
  wrench[2].add(torque_y, deviation.torque_y);
}

void BoomErrors::addSample(const simulation::OnBoomTruth& truth, const SampleResult& result) {
  ++samples;
  force_x.add(result.wrench.force_x, truth.load.force_x);
  force_z.add(result.wrench.force_z, truth.load.force_z);
  const auto stated = life::LoadError::of;
  life_force_z.add(result.wrench.force_z, truth.load.force_z,
                   stated(result.ofExtreme().deviation.force_z, result.deviation.common().force_z));
  addWrench(truth, result);
  moment.add(result.wrench.torque_y, truth.load.torque_y + truth.drive_reaction_y);
  const BoomState& boom = *result.boom;
  unknown += boom.contact_unknown;
  frequency = boom.frequency.size() > 0 ? boom.frequency[0] : 0.0;
  withheld += boom.useless;
  if (boom.useless) return;
  for (int j = 0; j < 3; ++j) {
    const double weight = boom.loads.weight[j + 1], total = boom.loads.total[j + 1];
    torque[j].add(total - weight, -truth.hold[j] - weight);
    life_torque[j].add(total, -truth.hold[j], stated(boom.deviations.torque[j + 1], boom.common.torque[j + 1]));
    torque_stated[j] += square(boom.deviations.torque[j + 1]);
    torques.add(total + truth.hold[j], boom.deviations.torque[j + 1]);
  }
  for (std::size_t s = 0; s < 3; ++s) {
    const double bending = boom.steel.section[s].torque.y(), right = truth.cut[s].torque_y;
    section[s].add(bending, right);
    life_section[s].add(bending, right,
                        stated(boom.deviations.section[s].torque.y(), boom.common.section[s].torque.y()));
    bendings.add(bending - right, boom.deviations.section[s].torque.y());
  }
  contact.add(boom.contact.force.z(), truth.rock.force_z);
  lost_as_shown += boom.hold_down_force_lost == (truth.rock.force_z < kLeastContact);
}

BoomErrors boomErrors(const simulation::Session& session, const Settings& settings, const SensorsOnBoom& sensors,
                      double from, double to) {
  SessionPlayer player(settings.mechanism, settings.pipeline, settings.boom, session);
  player.imu_speaks = sensors.imu, player.pressures_speak = sensors.pressures;
  BoomErrors errors;
  std::size_t i = 0;
  player.playTo(to, [&](double time, const SampleResult& result) {
    const simulation::OnBoomTruth& truth = session.on_boom[i++];
    if (time < from) return;
    errors.addBlows(session, result);
    const bool known = !result.refusal && result.boom != nullptr && !result.boom->fault;
    if (known && result.isPublished()) errors.addSample(truth, result);  // as it is published
    errors.refused += !known;
  });
  for (const Warning& warning : warningsOf(player.pipeline)) errors.warnings.insert(warning.key);
  return errors;
}

}  // namespace hammer_loads::accuracy
