#include "hammer_loads/bench/kdl_observer.h"

#if __has_include(<kdl/chainexternalwrenchestimator.hpp>)
#include <kdl/chainexternalwrenchestimator.hpp>
#define HAMMER_LOADS_KDL_OBSERVER
#endif
#include <algorithm>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/util/constants.h"
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
class JointLine {
 public:
  explicit JointLine(const simulation::Session& session) : readings_(session.joints) {}
  void at(StampNs stamp, KDL::JntArray& position, KDL::JntArray& velocity) {
    while (next_ + 1 < readings_.size() && readings_[next_].stamp < stamp) ++next_;
    const simulation::JointReading& b = readings_[next_];
    const simulation::JointReading& a = readings_[next_ == 0 ? 0 : next_ - 1];
    const double part =
        b.stamp > a.stamp ? static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp) : 0.0;
    for (unsigned j = 0; j < 4; ++j) {
      position(j) = a.position[j] + part * (b.position[j] - a.position[j]);
      velocity(j) = a.velocity[j] + part * (b.velocity[j] - a.velocity[j]);
    }
  }

 private:
  const std::vector<simulation::JointReading>& readings_;
  std::size_t next_{};
};

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
  JointLine line(session);
  Signals signals;
  bool first = true;
  for (const simulation::PressureReading& reading : pressures) {
    line.at(reading.stamp, position, velocity);
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

std::vector<ObserverRow> observerTable() {
  std::vector<ObserverRow> rows;
  const Settings settings = shippedBoom("{boom: compliant, boom_stiffness: identified, hull_motion: model}");
  const Settings by_imu = shippedBoom("{boom: compliant, boom_stiffness: identified, hull_motion: imu}");
  for (const bool on_rock : {false, true}) {
    const std::string name = on_rock ? "hull pressed on rock with 4 kN" : "hull free of the rock";
    simulation::MachineSettings machine = machineOnBoom(kObservedTo);
    if (on_rock) machine.on_boom.rock = {3e7, 3.0, kPressed};
    const simulation::Session session = simulation::recordSession(machine);
    std::optional<OuterLoadErrors> best;
    double best_gain = 0.0;
    for (const double gain : kObserverGains) {
      const auto errors = kdlErrors(session, settings, gain, kObservedFrom, kObservedTo);
      if (errors && (!best || errors->force_z.rms() < best->force_z.rms())) best = errors, best_gain = gain;
    }
    if (best) rows.push_back({name, format("KDL's momentum observer, gain %.0f", best_gain), *best});
    rows.push_back({name, "this package", pipelineErrors(session, settings, false, kObservedFrom, kObservedTo)});
    rows.push_back({name, "with an IMU", pipelineErrors(session, by_imu, true, kObservedFrom, kObservedTo)});
  }
  return rows;
}

std::string markdown(const std::vector<ObserverRow>& rows) {
  std::string text = "| machine | way | Fx | Fz | moment | worst sample of Fz |\n|---|---|---|---|---|---|\n";
  for (const ObserverRow& r : rows)
    text += format("| %s | %s | %.1f %% | %.1f %% | %.1f %% | %.0f %% |\n", r.machine.c_str(), r.way.c_str(),
                   100.0 * r.errors.force_x.rmsOfLargest(), 100.0 * r.errors.force_z.rmsOfLargest(),
                   100.0 * r.errors.moment.rmsOfLargest(), 100.0 * r.errors.force_z.worstOfLargest());
  return text;
}

}  // namespace hammer_loads::accuracy
