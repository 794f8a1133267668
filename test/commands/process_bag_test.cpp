/// process_bag on the recorded sessions, compared with their truth.
#include <cstdio>

#include "commands/bag_files.h"
#include "hammer_loads/ros/bag_processing.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "support/csv.h"
#include "support/session_bounds.h"

namespace hammer_loads {
namespace {

using accuracy::BlowAt;
using accuracy::WrenchAt;

constexpr double kSessionStart = 1700000000.0;  // [s] of both sessions

std::string data(const std::string& name) { return std::string(HAMMER_LOADS_TEST_DATA) + "/" + name; }

ParameterMap parametersWithInertia(double factor) {
  ParameterMap given =
      *readParameterFile(configDirectory() + "/hammer_mo100.yaml", *std::make_unique<std::vector<std::string>>());
  given["drive_inertia_kg_m2"].value = YAML::Load(std::to_string(0.6 * factor));
  given["level"] = {YAML::Load("rocker"), "level of the recorded machine"};
  given["crank_zero_std_rad"] = {YAML::Load("0.003"), "known zero of the recorded machine"};
  return given;
}

double sinceStart(const ros::Time& time) { return (time - ros::Time(kSessionStart)).toSec(); }

struct Loads {
  std::vector<WrenchAt> wrenches;
  std::vector<BlowAt> blows;
};

Loads truthOf(const std::string& session) {
  Loads truth;
  const test::Csv samples = test::dataCsv(session + "_truth.csv"), blows = test::dataCsv(session + "_blows.csv");
  constexpr double kDriveInertia = 0.6;  // [kg m2] of the session's machine, on the crank's shaft
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double drive = -kDriveInertia * samples.number(i, "crank_accel_rad_s2");
    truth.wrenches.push_back({samples.number(i, "t_s"), samples.number(i, "hull_force_x_N"),
                              samples.number(i, "hull_force_z_N"), samples.number(i, "hull_torque_y_Nm") + drive});
  }
  for (std::size_t i = 0; i < blows.size(); ++i)
    truth.blows.push_back({blows.number(i, "t_s"), blows.number(i, "blow_energy_J"), blows.number(i, "tool_impulse_Ns"),
                           blows.number(i, "turn_peak_force_z_N"), blows.number(i, "turn_impulse_z_Ns")});
  return truth;
}

std::vector<double> endsOfDropOuts(const std::vector<WrenchAt>& samples) {
  std::vector<double> ends;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].time - samples[i - 1].time > 0.02) ends.push_back(samples[i].time);
  }
  return ends;
}

Loads outputOf(const std::string& path) {
  Loads output;
  std::map<double, Pulse> pulses;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    if (const auto w = item.instantiate<geometry_msgs::WrenchStamped>()) {
      output.wrenches.push_back(
          {sinceStart(w->header.stamp), w->wrench.force.x, w->wrench.force.z, w->wrench.torque.y});
    } else if (const auto b = item.instantiate<Blow>()) {
      output.blows.push_back({sinceStart(b->header.stamp), b->energy, b->tool_impulse_z});
    } else if (const auto p = item.instantiate<Pulse>()) {
      pulses[sinceStart(p->header.stamp)] = *p;
    }
  }
  for (BlowAt& blow : output.blows) {
    const auto pulse = pulses.find(blow.time);  // stamped with the blow that ends its revolution
    if (pulse == pulses.end()) continue;
    blow.turn_peak = pulse->second.amplitude;
    blow.turn_impulse_z = pulse->second.turn_impulse_z;
  }
  return output;
}

struct SessionCase {
  const char* session;
  test::SessionBounds bounds;
};

class RecordedSession : public test::BagFiles, public testing::WithParamInterface<std::tuple<SessionCase, double>> {};

TEST_P(RecordedSession, StaysWithinTheBounds) {
  const auto& [session_case, inertia_factor] = GetParam();
  const std::string session = session_case.session;
  BagJob job;
  job.inputs = {data(session + ".bag")};
  job.output = path("out.bag");
  job.parameters = parametersWithInertia(inertia_factor);
  BagReport report;
  ASSERT_EQ(processBag(
                job, [](double) {}, report),
            std::vector<std::string>{});
  const Loads truth = truthOf(session);
  const Loads output = outputOf(path("out.bag"));
  EXPECT_EQ(output.wrenches.size() + report.crank.beside_blow + report.crank.uncertain, report.crank.accepted);
  const accuracy::Judged judged{3.0, truth.wrenches.back().time - 3.0, endsOfDropOuts(truth.wrenches)};
  const auto e = accuracy::sessionErrors(output.wrenches, truth.wrenches, output.blows, truth.blows, judged);
  test::expectWithin(e, session_case.bounds);
  EXPECT_GT(e.blows, 50);
  // For the README: scripts/update_accuracy.
  std::printf("| %s | %.0f %% | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %.3f ms | %.2f %% |\n",
              session_case.session, 100 * (inertia_factor - 1), 100 * e.x.rms, 100 * e.z.rms, 100 * e.torque.rms,
              100 * e.turn_peak, 100 * e.turn_impulse, 1e3 * e.blow_time, 100 * e.energy);
}

INSTANTIATE_TEST_SUITE_P(Sessions, RecordedSession,
                         testing::Combine(testing::Values(SessionCase{"mo100_1khz", test::kBounds1kHz},
                                                          SessionCase{"mo100_100hz", test::kBounds100Hz}),
                                          testing::Values(1.0, 0.5, 1.5)));

}  // namespace
}  // namespace hammer_loads
