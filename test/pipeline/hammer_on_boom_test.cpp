// The pipeline against a machine whose hull, boom, crank and flywheel move together: a truth of its own equations.
#include "hammer_loads/simulation/hammer_on_boom.h"

#include <gtest/gtest.h>

#include <random>

#include "hammer_loads/simulation/session.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using simulation::HammerOnBoom;
using simulation::OnBoomTruth;
constexpr double kMillisecond = 1e-3, kBegin = 3.0, kEnd = 8.0;
constexpr StampNs kMs = 1000000;

struct Recording {
  std::vector<OnBoomTruth> truth;
  std::vector<simulation::OnBoomBlow> blows;
};

const Recording& recording() {
  static const Recording recorded = [] {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.drive.stop_time = 1e9;
    machine.drive.start_time = 0.0, machine.drive.start_ramp = 0.5, machine.start_angle = 3.0;  // goes forward at once
    HammerOnBoom hammer(machine, simulation::oilBoomEo2621());
    Recording r;
    for (int i = 1; i * kMillisecond < kEnd; ++i) {
      hammer.advanceTo(i * kMillisecond);
      r.truth.push_back(hammer.truth());
    }
    r.blows = hammer.blows();
    return r;
  }();
  return recorded;
}

/// Which sensors speak, and what they get wrong.
struct Sensors {
  bool imu{}, pressures{};
  double zero{};         ///< of the encoder [rad]
  double crank_noise{};  ///< of angle [rad], times 300 of speed [rad/s]
  double imu_noise{};    ///< [m/s2], a sixtieth of it [rad/s]
  double pressure_noise{};  ///< [Pa]
};

/// Plays the machine's sensors into a pipeline; each(truth, result) for every sample after kBegin.
template <typename Each>
void play(Pipeline& pipeline, const Sensors& sensors, const Each& each) {
  std::mt19937_64 random(7);
  const auto noise = [&](double size) { return size > 0.0 ? size * std::normal_distribution<>()(random) : 0.0; };
  const auto& pose = simulation::oilBoomEo2621().pose;
  const std::vector<std::string> names{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};
  int i = 0;
  for (const OnBoomTruth& t : recording().truth) {
    const StampNs stamp = 1000000000 + (++i) * kMs;
    if (i % 20 == 1) pipeline.boomJoints(stamp, names, {0.0, pose[0], pose[1], pose[2]}, {0.0, 0.0, 0.0, 0.0});
    if (sensors.imu)
      pipeline.hullImu(stamp, {{t.imu_x + noise(sensors.imu_noise), 0.0, t.imu_z + noise(sensors.imu_noise)},
                               {0.0, t.imu_rate + noise(sensors.imu_noise / 60.0), 0.0}});
    for (std::size_t c = 0; sensors.pressures && c < 3; ++c) {
      pipeline.cylinderPressure(stamp, c, Chamber::kBore, t.bore_pressure[c] + noise(sensors.pressure_noise));
      pipeline.cylinderPressure(stamp, c, Chamber::kRod, t.rod_pressure[c] + noise(sensors.pressure_noise));
    }
    const SampleResult& result =
        pipeline.crankSample(stamp, {std::remainder(t.angle + sensors.zero + noise(sensors.crank_noise), kTwoPi),
                                     t.speed + noise(300.0 * sensors.crank_noise)});
    if (t.time > kBegin) each(t, result);
  }
}

/// Errors over root mean square and over the largest of the truth.
struct Error {
  double square{}, size{}, worst{}, largest{};
  int count{};
  void add(double estimate, double truth) {
    square += std::pow(estimate - truth, 2), size += truth * truth, ++count;
    worst = std::max(worst, std::abs(estimate - truth)), largest = std::max(largest, std::abs(truth));
  }
  double rms() const { return std::sqrt(square / size); }
  double rmsOfLargest() const { return std::sqrt(square / count) / largest; }
  double worstOfLargest() const { return worst / largest; }
};

struct Errors {
  Error force_z, moment, torque[3], section;
  std::size_t samples{}, blows{}, refused{};
  double energy{};  ///< mean, relative
};

std::size_t sectionNamed(const Boom& boom, const std::string& name) {
  for (std::size_t i = 0; i < boom.sections().size(); ++i)
    if (boom.sections()[i].name() == name) return i;
  throw std::runtime_error(name);
}

Errors errorsOf(const std::string& parameters, const Sensors& sensors) {
  const Settings settings = test::settingsWith(parameters);
  Pipeline pipeline(settings.mechanism, settings.pipeline, settings.boom);
  const std::size_t section = sectionNamed(*settings.boom, "boom_middle");
  Errors e;
  play(pipeline, sensors, [&](const OnBoomTruth& t, const SampleResult& result) {
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const double time = seconds(result.ends[k].stamp - 1000000000);
      for (const simulation::OnBoomBlow& blow : recording().blows) {
        if (std::abs(blow.time - time) > 0.01) continue;
        e.energy += result.ends[k].blow.energy / blow.energy - 1.0;
        ++e.blows;
      }
    }
    if (result.refusal || result.boom == nullptr || result.boom->fault) {
      ++e.refused;
      return;
    }
    ++e.samples;
    e.force_z.add(result.wrench.force_z, t.load.force_z);
    e.moment.add(result.wrench.torque_y, t.load.torque_y);
    const BoomState& boom = *result.boom;
    for (int j = 0; j < 3; ++j)
      e.torque[j].add(boom.loads.total[j + 1] - boom.loads.weight[j + 1], -t.hold[j] - boom.loads.weight[j + 1]);
    e.section.add(boom.steel.section[section].torque.y(), t.cut.torque_y);
  });
  e.energy /= static_cast<double>(std::max<std::size_t>(1, e.blows));
  return e;
}

void print(const char* name, const Errors& e) {
  std::printf("%s: Fz %.2f|%.2f  My %.2f|%.2f  boom %.2f|%.2f arm %.2f|%.2f hammer %.2f|%.2f  section %.2f|%.2f %%  energy "
              "%.2f %%  refused %zu of %zu, blows %zu\n",
              name, 100 * e.force_z.rmsOfLargest(), 100 * e.force_z.worstOfLargest(), 100 * e.moment.rms(),
              100 * e.moment.worstOfLargest(), 100 * e.torque[0].rms(), 100 * e.torque[0].worstOfLargest(),
              100 * e.torque[1].rms(), 100 * e.torque[1].worstOfLargest(), 100 * e.torque[2].rms(),
              100 * e.torque[2].worstOfLargest(), 100 * e.section.rmsOfLargest(), 100 * e.section.worstOfLargest(),
              100 * e.energy, e.refused, e.samples, e.blows);
}

TEST(HammerOnBoomSession, Figures) {
  print("model", errorsOf("boom: compliant\nhull_motion: model\n", {}));
  print("fixed", errorsOf("boom: compliant\n", {}));
  print("imu", errorsOf("boom: compliant\nhull_motion: imu\n", {true}));
  print("model -30%", errorsOf("boom: compliant\nhull_motion: model\nbulk_modulus_Pa: 0.7e9\n", {}));
  print("model +40%", errorsOf("boom: compliant\nhull_motion: model\nbulk_modulus_Pa: 1.4e9\n", {}));
  const std::string identified = "boom: compliant\nhull_motion: model\nboom_stiffness: identified\n";
  print("identified imu -30%", errorsOf(identified + "bulk_modulus_Pa: 0.7e9\n", {true, false, 0, 0, 0.3}));
  print("identified imu +40%", errorsOf(identified + "bulk_modulus_Pa: 1.4e9\n", {true, false, 0, 0, 0.3}));
  print("identified pressures +40%", errorsOf(identified + "bulk_modulus_Pa: 1.4e9\n", {false, true, 0, 0, 0, 2e4}));
}

}  // namespace
}  // namespace hammer_loads
