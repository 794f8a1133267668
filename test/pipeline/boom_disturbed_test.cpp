// What the boom carries while a sensor gives one damaged reading, and after a gap in which nobody followed it: close to
// the truth or with a deviation that says how far it may be.
#include <algorithm>
#include <functional>
#include <vector>

#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using accuracy::BoomErrors;
using accuracy::SensorsOnBoom;
using simulation::Session;

constexpr double kDisturbed = 5.0, kBack = 6.2;  // [s]
constexpr char kBoomGiven[] = "{boom: compliant, hull_motion: model}";
constexpr char kBoomIdentified[] = "{boom: compliant, hull_motion: model, boom_stiffness: identified}";
constexpr char kHullByImu[] = "{boom: compliant, hull_motion: imu, boom_stiffness: identified}";

simulation::MachineSettings machine() {
  simulation::MachineSettings m = test::machineOnBoom(1.0, 50.0);
  m.drive.start_time = 0.1;
  m.duration = 8.0;
  return m;
}

BoomErrors errors(const Session& session, const char* keys, const SensorsOnBoom& sensors, double from, double to) {
  const Settings settings = accuracy::shippedBoom(keys);
  const BoomErrors e =
      accuracy::boomErrors(session, settings.mechanism, settings.pipeline, *settings.boom, sensors, from, to);
  std::printf("%s\n", e.text().c_str());
  return e;
}

/// Readings that follow an instant.
template <typename Reading>
Reading* after(std::vector<Reading>& readings, double time) {
  const auto start = simulation::workingMo100().start_stamp;
  const auto at = std::find_if(readings.begin(), readings.end(),
                               [&](const Reading& r) { return 1e-9 * static_cast<double>(r.stamp - start) >= time; });
  return &*at;
}

struct Damage {
  const char* name;
  bool by_pressures;  ///< else by IMU
  std::function<void(Session&, double time, int reading)> to;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class DamagedReading : public testing::TestWithParam<Damage> {
 protected:
  static const Session& whole() {
    static const Session session = simulation::recordSession(machine());
    return session;
  }
  /// So many damaged readings in a row at a time, judged from there on.
  BoomErrors with(int readings, double time) const {
    Session damaged = whole();
    for (int i = 0; i < readings; ++i) GetParam().to(damaged, time, i);
    const bool by_pressures = GetParam().by_pressures;
    return errors(damaged, by_pressures ? kBoomIdentified : kHullByImu, {!by_pressures, by_pressures}, kDisturbed, 5.6);
  }
};

TEST_P(DamagedReading, CostsItselfAlone) {
  for (const double time : {5.0, 5.07, 5.13}) {
    const BoomErrors e = with(1, time);
    EXPECT_LT(e.worstTorque(), 0.03) << time;
    EXPECT_LT(e.force_z.worstOfLargest(), 0.05) << time;
    EXPECT_GT(e.covered(), 0.85) << time;
    EXPECT_EQ(e.refused, 0U) << time;
  }
  const BoomErrors three = with(3, 5.07);
  EXPECT_TRUE(three.worstTorque() > 0.06 || three.force_z.worstOfLargest() > 0.3) << "what there is to see";
}

INSTANTIATE_TEST_SUITE_P(
    Sensors, DamagedReading,
    testing::Values(
        Damage{"joint off", false, [](Session& s, double t, int i) { after(s.joints, t)[i].position[1] += 0.5; }},
        Damage{"joints zero", false, [](Session& s, double t, int i) { after(s.joints, t)[i].position = {}; }},
        Damage{"acceleration", false,
               [](Session& s, double t, int i) { after(s.imu, t)[i].specific_force[2] = 1000.0; }},
        Damage{"turning rate", false, [](Session& s, double t, int i) { after(s.imu, t)[i].rate[1] = 30.0; }},
        Damage{"bore pressure", true, [](Session& s, double t, int i) { after(s.pressures, t)[i].bore[0] = 5e7; }},
        Damage{"rod pressure", true, [](Session& s, double t, int i) { after(s.pressures, t)[i].rod[2] = 4e7; }}));

/// The hammer went on all the while.
Session withGap(double from, double to) {
  simulation::MachineSettings m = machine();
  m.crank.drop_outs = {{from, to}};
  return simulation::recordSession(m);
}

TEST(GapOfTheCrank, TheBoomMaySwingInAWayNotKnown) {
  const BoomErrors e = errors(withGap(kDisturbed, kBack), kBoomGiven, {}, kBack, 7.2);
  EXPECT_GT(e.worstTorque(), 0.4) << "what the deviations must say";
  EXPECT_GT(e.covered(), 0.85);
  EXPECT_GT(e.sectionsCovered(), 0.85);
}

TEST(GapOfTheCrank, ANodeThatIsStartedInMidWorkKnowsThatItDoesNotKnow) {
  const BoomErrors e = errors(withGap(0.0, kBack), kBoomGiven, {}, kBack, 7.2);
  EXPECT_GT(e.worstTorque(), 0.4) << "what the deviations must say";
  EXPECT_GT(e.covered(), 0.85);
}

TEST(GapOfTheCrank, SensorsFindTheVibrationAtOnce) {
  const Session session = withGap(kDisturbed, kBack);
  for (const bool by_pressures : {false, true}) {
    const BoomErrors e =
        errors(session, by_pressures ? kBoomIdentified : kHullByImu, {!by_pressures, by_pressures}, kBack, 7.2);
    EXPECT_LT(e.worstTorque(), 0.05) << by_pressures;
    EXPECT_LT(e.worstSection(), 0.04) << by_pressures;
    EXPECT_GT(e.covered(), 0.85) << by_pressures;
  }
}

/// What was not followed says nothing of how good a measured torque is.
TEST(GapOfTheCrank, LeavesTheDeviationOfMeasuredTorquesAsItWas) {
  const Session session = withGap(kDisturbed, kBack);
  const Settings settings = accuracy::shippedBoom(kBoomIdentified);
  test::Player player(settings, true, session);
  player.imu_speaks = false;
  double before = 0.0, after = 0.0;
  player.playTo(7.2, [&](double time, const SampleResult& r) {
    if (r.refusal || !r.boom || r.boom->fault) return;
    double& worst = time < kDisturbed ? before : after;
    if (time > 4.0) worst = std::max(worst, r.boom->deviations.torque[1]);
  });
  EXPECT_GT(before, 0.0);
  EXPECT_LT(after, 1.5 * before);
}

}  // namespace
}  // namespace hammer_loads
