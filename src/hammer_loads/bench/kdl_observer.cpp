#include "hammer_loads/bench/kdl_observer.h"

#if __has_include(<kdl/chainexternalwrenchestimator.hpp>)
#include <kdl/chainexternalwrenchestimator.hpp>
#define HAMMER_LOADS_KDL_OBSERVER
#endif
#include <algorithm>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kObservedFrom = 6.0, kObservedTo = 10.0;  // [s]
constexpr double kPressed = 4000.0;                        // [N]

struct OuterLoad {
  double force_x, force_z, moment;
};

/// Estimates and truth at the same instants.
struct Signals {
  std::vector<OuterLoad> estimate, truth;

  OuterLoadErrors errors() const {
    const auto of = [&](double OuterLoad::*part) {
      double means[2]{};
      for (std::size_t i = 0; i < truth.size(); ++i) means[0] += estimate[i].*part, means[1] += truth[i].*part;
      SignalError error;
      const auto count = static_cast<double>(truth.size());
      for (std::size_t i = 0; i < truth.size(); ++i)
        error.add(estimate[i].*part - means[0] / count, truth[i].*part - means[1] / count);
      return error;
    };
    return {of(&OuterLoad::force_x), of(&OuterLoad::force_z), of(&OuterLoad::moment)};
  }
};

OuterLoad truthOf(const simulation::OnBoomTruth& truth) {
  return {truth.load.force_x + truth.rock.force_x, truth.load.force_z + truth.rock.force_z,
          truth.load.torque_y + truth.drive_reaction_y + truth.rock.torque_y};
}

#ifdef HAMMER_LOADS_KDL_OBSERVER

/// Joints at an instant, on the line between two readings.
void jointsAt(const std::vector<simulation::JointReading>& readings, StampNs stamp, KDL::JntArray& position,
              KDL::JntArray& velocity) {
  const auto after =
      std::lower_bound(readings.begin(), std::prev(readings.end()), stamp,
                       [](const simulation::JointReading& r, StampNs wanted) { return r.stamp < wanted; });
  const simulation::JointReading &b = *after, &a = after == readings.begin() ? b : *std::prev(after);
  const double part =
      b.stamp > a.stamp ? static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp) : 0.0;
  for (unsigned j = 0; j < 4; ++j) {
    position(j) = a.position[j] + part * (b.position[j] - a.position[j]);
    velocity(j) = a.velocity[j] + part * (b.velocity[j] - a.velocity[j]);
  }
}

/// Nearest in time.
const simulation::OnBoomTruth& truthAt(const simulation::Session& session, double time) {
  const auto& truth = session.truth;
  auto after = std::lower_bound(truth.begin(), truth.end(), time,
                                [](const simulation::CrankTruth& t, double wanted) { return t.time < wanted; });
  if (after == truth.end() || (after != truth.begin() && time - (after - 1)->time < after->time - time)) --after;
  return session.on_boom[static_cast<std::size_t>(after - truth.begin())];
}

#endif

}  // namespace

#ifdef HAMMER_LOADS_KDL_OBSERVER
std::optional<OuterLoadErrors> kdlErrors(const simulation::Session& session, const Settings& settings, double gain,
                                         double from, double to) {
  const Boom& boom = *settings.boom;
  const auto& pressures = session.pressures;
  const double rate = 1.0 / seconds(pressures[1].stamp - pressures[0].stamp);
  const Eigen::Vector3d g_B = gravityInRoot(settings.pipeline.gravity, {});
  KDL::ChainExternalWrenchEstimator observer(boom.chain().kdl(), KDL::Vector(g_B.x(), g_B.y(), g_B.z()), rate, gain,
                                             0.0);
  const auto joints = static_cast<unsigned>(boom.chain().joints());
  KDL::JntArray position(joints), velocity(joints), torque(joints);
  Signals signals;
  bool first = true;
  for (const simulation::PressureReading& reading : pressures) {
    jointsAt(session.joints, reading.stamp, position, velocity);
    for (std::size_t i = 0; i < boom.cylinders().size(); ++i) {
      const Cylinder& cylinder = boom.cylinders()[i];
      const auto joint = static_cast<unsigned>(cylinder.joint());
      torque(joint) = forceOf(cylinder, {reading.bore[i], reading.rod[i]}) * cylinder.at(position(joint)).arm;
    }
    if (first) observer.setInitialMomentum(position, velocity);
    first = false;
    KDL::Wrench outer;
    if (observer.JntToExtWrench(position, velocity, torque, outer) < 0) return std::nullopt;
    const double time = seconds(reading.stamp - simulation::workingMo100().start_stamp);
    if (time < from || time > to) continue;
    signals.estimate.push_back({outer.force.x(), outer.force.z(), outer.torque.y()});
    signals.truth.push_back(truthOf(truthAt(session, time)));
  }
  return signals.errors();
}
#else
std::optional<OuterLoadErrors> kdlErrors(const simulation::Session&, const Settings&, double, double, double) {
  return std::nullopt;
}
#endif

OuterLoadErrors pipelineErrors(const simulation::Session& session, const Settings& settings, bool imu, double from,
                               double to) {
  SessionPlayer player(settings.mechanism, settings.pipeline, settings.boom, session);
  player.imu_speaks = imu;
  Signals signals;
  std::size_t i = 0;
  player.playTo(to, [&](double time, const SampleResult& result) {
    const simulation::OnBoomTruth& truth = session.on_boom[i++];
    if (time < from || !result.isPublished() || result.boom == nullptr || result.boom->fault) return;
    const Wrench& rock = result.boom->contact;
    signals.estimate.push_back({result.wrench.force_x + rock.force.x(), result.wrench.force_z + rock.force.z(),
                                result.wrench.torque_y + rock.torque.y()});
    signals.truth.push_back(truthOf(truth));
  });
  return signals.errors();
}

Table observerTable() {
  Table table(4);
  const Settings settings = shippedBoom("{boom: compliant, boom_stiffness: identified, hull_motion: model}");
  const Settings by_imu = shippedBoom("{boom: compliant, boom_stiffness: identified, hull_motion: imu}");
  for (const bool on_rock : {false, true}) {
    simulation::MachineSettings machine = machineOnBoom(kObservedTo);
    if (on_rock) machine.on_boom.rock = {3e7, 3.0, kPressed};
    const simulation::Session session = simulation::recordSession(machine);
    const auto add = [&](const std::string& way, const OuterLoadErrors& errors) {
      table.beginRow();
      table.text("machine", "machine", on_rock ? "hull pressed on rock with 4 kN" : "hull free of the rock");
      table.text("way", "way", way);
      table.percent("Fx", "rms_x", 1, errors.force_x.rmsOfLargest());
      table.percent("Fz", "rms_z", 1, errors.force_z.rmsOfLargest());
      table.percent("moment", "rms_torque", 1, errors.moment.rmsOfLargest());
      table.percent("worst sample of Fz", "worst_z", 0, errors.force_z.worstOfLargest());
    };
    std::optional<OuterLoadErrors> best;
    double best_gain = 0.0;
    for (const double gain : kObserverGains) {
      const auto errors = kdlErrors(session, settings, gain, kObservedFrom, kObservedTo);
      if (errors && (!best || errors->force_z.rms() < best->force_z.rms())) best = errors, best_gain = gain;
    }
    if (best) add(format("KDL's momentum observer, gain %.0f", best_gain), *best);
    add("this package", pipelineErrors(session, settings, false, kObservedFrom, kObservedTo));
    add("with an IMU", pipelineErrors(session, by_imu, true, kObservedFrom, kObservedTo));
  }
  return table;
}

}  // namespace hammer_loads::accuracy
