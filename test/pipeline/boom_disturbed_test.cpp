// What the boom carries while a sensor gives one damaged reading, and after a gap in which nobody followed it: close to
// the truth or with a deviation that says how far it may be.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/warnings.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using accuracy::BoomErrors;
using accuracy::SensorsOnBoom;
using simulation::Session;

constexpr double kDisturbed = 5.0, kGoesOn = 6.2;  // [s]
constexpr char kBoomGiven[] = "{boom: compliant, hull_motion: model}";
constexpr char kBoomIdentified[] = "{boom: compliant, hull_motion: model, boom_stiffness: identified}";
constexpr char kHullByImu[] = "{boom: compliant, hull_motion: imu, boom_stiffness: identified}";

simulation::MachineSettings machine(bool on_rock = false) {
  simulation::MachineSettings m = test::machineOnBoom(1.0, 50.0);
  if (on_rock) m.on_boom.rock = {3e7, 3.0, 4000.0};
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

template <typename Reading>
void silence(std::vector<Reading>& readings, double from, double to) {
  const auto at = [&](double time) { return readings.begin() + (after(readings, time) - readings.data()); };
  readings.erase(at(from), at(to));
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
        Damage{"joint off", false, [](Session& s, double at, int i) { after(s.joints, at)[i].position[1] += 0.5; }},
        Damage{"joints zero", false, [](Session& s, double at, int i) { after(s.joints, at)[i].position = {}; }},
        Damage{"acceleration", false,
               [](Session& s, double at, int i) { after(s.imu, at)[i].specific_force[2] = 1000.0; }},
        Damage{"turning rate", false, [](Session& s, double at, int i) { after(s.imu, at)[i].rate[1] = 30.0; }},
        Damage{"bore pressure", true, [](Session& s, double at, int i) { after(s.pressures, at)[i].bore[0] = 5e7; }},
        Damage{"rod pressure", true, [](Session& s, double at, int i) { after(s.pressures, at)[i].rod[2] = 4e7; }}));

struct Mistake {
  const char* name;
  const char* warning;
  std::function<void(Session&)> make;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

/// A sensor that is connected, mounted or scaled otherwise than said: named, and not used. On a hull that hangs free
/// and on rock.
class Mistaken : public testing::TestWithParam<Mistake> {};

const Session& sessionOn(bool rock) {
  static const auto recorded = [](bool on_rock) {
    simulation::MachineSettings m = machine(on_rock);
    m.duration = 5.0;
    return simulation::recordSession(m);
  };
  static const Session free = recorded(false), bears = recorded(true);
  return rock ? bears : free;
}

bool warnsOf(const Pipeline& pipeline, const std::string& key) {
  const std::vector<Warning> warnings = warningsOf(pipeline);
  return std::any_of(warnings.begin(), warnings.end(), [&](const Warning& w) { return w.key == key; });
}

/// To the end; a warning, and whether the sensor is used.
struct Played {
  bool warned, used;
};

Played played(const Session& session, const std::string& sensor) {
  const bool by_pressures = sensor == "pressures";
  test::Player player(accuracy::shippedBoom(by_pressures ? kBoomGiven : kHullByImu), true, session);
  player.imu_speaks = !by_pressures, player.pressures_speak = by_pressures;
  player.playTo(5.0, [](double, const SampleResult&) {});
  const SampleResult& last = player.pipeline.result();
  return {warnsOf(player.pipeline, sensor),
          by_pressures ? last.boom != nullptr && last.boom->measured : player.pipeline.hull().motionKnown()};
}

TEST(MistakenSensors, RightOnesAreUsed) {
  for (const bool rock : {false, true}) {
    for (const char* sensor : {"pressures", "imu"}) {
      const Played as_said = played(sessionOn(rock), sensor);
      EXPECT_FALSE(as_said.warned) << sensor << rock;
      EXPECT_TRUE(as_said.used) << sensor << rock;
    }
  }
}

TEST_P(Mistaken, SensorsAreNamedAndNotUsed) {
  for (const bool rock : {false, true}) {
    Session session = sessionOn(rock);
    GetParam().make(session);
    const Played mistaken = played(session, GetParam().warning);
    EXPECT_TRUE(mistaken.warned) << rock;
    EXPECT_FALSE(mistaken.used) << rock;
  }
}

/// Until they were recognised they had a say in frequencies, damping and motion: none of that stays. A hull on rock is
/// far off without pressures, and says so.
TEST_P(Mistaken, SensorsLeaveNothingBehind) {
  for (const bool rock : {false, true}) {
    Session session = sessionOn(rock);
    GetParam().make(session);
    const bool by_pressures = std::string(GetParam().warning) == "pressures";
    const double from = std::string(GetParam().name) == "frozen" ? 4.8 : 3.5;
    const BoomErrors alone = errors(session, kBoomIdentified, {}, from, 5.0);
    const BoomErrors with = errors(session, kBoomIdentified, {!by_pressures, by_pressures}, from, 5.0);
    if (from < 4.0) {
      EXPECT_LT(with.worstTorque(), alone.worstTorque() + 0.15) << rock;
    }
    EXPECT_GT(with.covered(), 0.85) << rock;
    EXPECT_GT(with.sectionsCovered(), 0.85) << rock;
  }
}

/// A bus that takes 10 ms: torques are as late as the readings, and their deviations say so.
TEST(MistakenSensors, PressuresThatLagAreNamedAndTheirDeviationsWidened) {
  for (const bool rock : {false, true}) {
    for (const bool imu : {false, true}) {
      const char* keys = imu ? kHullByImu : kBoomIdentified;
      const BoomErrors right = errors(sessionOn(rock), keys, {imu, true}, 3.5, 5.0);
      EXPECT_LT(right.worstTorque(), 0.03) << rock << imu;
      EXPECT_FALSE(right.warned_of_pressure_stamps) << rock << imu;
      Session session = sessionOn(rock);
      for (simulation::PressureReading& r : session.pressures) r.stamp += 10'000'000;
      const BoomErrors late = errors(session, keys, {imu, true}, 3.5, 5.0);
      EXPECT_GT(late.worstTorque(), 0.3) << rock << imu << ": what there is to say";
      EXPECT_TRUE(late.warned_of_pressure_stamps) << rock << imu;
      EXPECT_GT(late.covered(), 0.85) << rock << imu;
      EXPECT_GT(late.sectionsCovered(), 0.85) << rock << imu;
    }
  }
}

template <typename Change>
std::function<void(Session&)> ofPressures(const Change& change) {
  return [change](Session& s) {
    for (simulation::PressureReading& r : s.pressures) change(r.bore, r.rod);
  };
}

template <typename Change>
std::function<void(Session&)> ofImu(const Change& change) {
  return [change](Session& s) {
    for (simulation::HullImuReading& r : s.imu) change(r.specific_force, r.rate);
  };
}

using Chambers = std::array<double, 3>;

INSTANTIATE_TEST_SUITE_P(
    Sensors, Mistaken,
    testing::Values(Mistake{"bar", "pressures", ofPressures([](Chambers& bore, Chambers& rod) {
                              for (Chambers* p : {&bore, &rod})
                                for (double& one : *p) one *= 1e-5;
                            })},
                    Mistake{"chambers of all exchanged", "pressures",
                            ofPressures([](Chambers& bore, Chambers& rod) { std::swap(bore, rod); })},
                    Mistake{"chambers of the boom's exchanged", "pressures",
                            ofPressures([](Chambers& bore, Chambers& rod) { std::swap(bore[0], rod[0]); })},
                    Mistake{"chambers of the hammer's exchanged", "pressures",
                            ofPressures([](Chambers& bore, Chambers& rod) { std::swap(bore[2], rod[2]); })},
                    Mistake{"boom and arm exchanged", "pressures", ofPressures([](Chambers& bore, Chambers& rod) {
                              std::swap(bore[0], bore[1]), std::swap(rod[0], rod[1]);
                            })},
                    Mistake{"in g", "imu", ofImu([](Chambers& force, Chambers&) {
                              for (double& one : force) one /= 9.80665;
                            })},
                    Mistake{"upside down", "imu",
                            ofImu([](Chambers& force, Chambers&) { force[0] = -force[0], force[2] = -force[2]; })},
                    Mistake{"degrees per second", "imu", ofImu([](Chambers&, Chambers& rate) {
                              for (double& one : rate) one *= 57.3;
                            })},
                    Mistake{"frozen", "imu", [](Session& s) {
                              const simulation::HullImuReading held = *after(s.imu, 4.5);
                              for (simulation::HullImuReading& r : s.imu)
                                if (r.stamp > held.stamp) r.specific_force = held.specific_force, r.rate = held.rate;
                            }}));

/// The hammer went on all the while.
Session withGap(double from, double to) {
  simulation::MachineSettings m = machine();
  m.crank.drop_outs = {{from, to}};
  return simulation::recordSession(m);
}

TEST(GapOfTheCrank, TheBoomMaySwingInAWayNotKnown) {
  const BoomErrors e = errors(withGap(kDisturbed, kGoesOn), kBoomGiven, {}, kGoesOn, 7.2);
  EXPECT_GT(e.worstTorque(), 0.4) << "what the deviations must say";
  EXPECT_GT(e.covered(), 0.85);
  EXPECT_GT(e.sectionsCovered(), 0.85);
}

TEST(GapOfTheCrank, ANodeThatIsStartedInMidWorkKnowsThatItDoesNotKnow) {
  const BoomErrors e = errors(withGap(0.0, kGoesOn), kBoomGiven, {}, kGoesOn, 7.2);
  EXPECT_GT(e.worstTorque(), 0.4) << "what the deviations must say";
  EXPECT_GT(e.covered(), 0.85);
}

TEST(GapOfTheCrank, SensorsFindTheVibrationAtOnce) {
  const Session session = withGap(kDisturbed, kGoesOn);
  for (const bool by_pressures : {false, true}) {
    const BoomErrors e =
        errors(session, by_pressures ? kBoomIdentified : kHullByImu, {!by_pressures, by_pressures}, kGoesOn, 7.2);
    EXPECT_LT(e.worstTorque(), 0.05) << by_pressures;
    EXPECT_LT(e.worstSection(), 0.04) << by_pressures;
    EXPECT_GT(e.covered(), 0.85) << by_pressures;
  }
}

/// Pressures that stop, for a second: the torques go on from the last reading, which says less and less of them.
TEST(PressuresThatStop, AreAnErrorThatGrowsUntilTheyAreBack) {
  for (const bool rock : {false, true}) {
    Session session = simulation::recordSession(machine(rock));
    silence(session.pressures, kDisturbed, 6.0);
    const auto within = [&](double from, double to) {
      return errors(session, kBoomIdentified, {false, true}, from, to);
    };
    EXPECT_GT(within(4.0, kDisturbed).covered(), 0.85) << rock;
    const BoomErrors overdue = within(kDisturbed, 5.2), back = within(6.0, 6.2);
    EXPECT_GT(overdue.worstTorque(), 0.1) << rock << ": what there is to say";
    EXPECT_GT(overdue.covered(), 0.85) << rock;
    EXPECT_GT(overdue.sectionsCovered(), 0.85) << rock;
    EXPECT_GT(back.covered(), 0.85) << rock;
    EXPECT_LT(back.worstTorque(), 0.1) << rock;
  }
}

/// What the IMU has shown of frequencies and damping goes on without it, and moves the hull under the hammer.
TEST(ImuThatStops, LeavesTheHullsMotionToTheModel) {
  Session session = simulation::recordSession(machine());
  silence(session.imu, kDisturbed, 6.0);
  const BoomErrors fixed = errors(session, "{boom: compliant, hull_motion: fixed}", {}, kDisturbed, 6.0);
  EXPECT_GT(fixed.force_z.worstOfLargest(), 0.08) << "what the hull's motion is worth";
  const BoomErrors e = errors(session, kHullByImu, {true, false}, kDisturbed, 6.0);
  EXPECT_EQ(e.refused, 0U);
  EXPECT_LT(e.force_z.worstOfLargest(), 0.04);
  EXPECT_LT(std::abs(e.energy()), 0.02);
  EXPECT_LT(e.worstTorque(), 0.04);
  EXPECT_GT(e.covered(), 0.85);
}

/// Of a boom that is no model: what it showed last is soon no longer true.
TEST(ImuThatStops, IsForgottenWithoutAJump) {
  simulation::MachineSettings m = accuracy::machineOnBoom(7.0);
  m.drive.start_time = 0.1;
  Session session = simulation::recordSession(m);
  auto& all = session.imu;
  const std::int64_t first = all.front().stamp, period = 310'000'000, silent = 60'000'000;
  all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& r) { return (r.stamp - first) % period < silent; }),
            all.end());
  const char* keys = "{boom: rigid, hull_motion: imu}";
  const BoomErrors e = errors(session, keys, {true, false}, 3.0, 6.9);
  EXPECT_LT(e.force_z.worstOfLargest(), 0.15);
  EXPECT_LT(e.force_z.rms(), 0.06);
  EXPECT_EQ(e.refused, 0U);
}

/// What is lasting and no rock makes is an error of the sensors, or of masses and lengths.
TEST(PressuresThatAreOff, SaySo) {
  const std::vector<std::function<double(double)>> wrong{[](double p) { return 1.02 * p; },
                                                         [](double p) { return p + 1e5; }};
  for (const bool rock : {false, true}) {
    const Session right = simulation::recordSession(machine(rock));
    for (const auto& read : wrong) {
      Session session = right;
      for (auto& r : session.pressures)
        for (double& p : r.bore) p = read(p);
      const BoomErrors e = errors(session, kBoomIdentified, {false, true}, 4.0, 7.0);
      EXPECT_GT(e.worstTorque(), 0.02) << "what there is to say";
      EXPECT_GT(e.covered(), rock ? 0.6 : 0.85) << rock << ": along the tool rock may be what makes it";
      EXPECT_GT(e.sectionsCovered(), 0.85) << rock;
    }
  }
}

/// Few readings say how good a measured torque is as well as many.
TEST(PressuresThatBegin, HaveATrueDeviationAtOnce) {
  simulation::MachineSettings m = machine();
  m.on_boom.pressures.rate = 100.0;
  const Session session = simulation::recordSession(m);
  EXPECT_GT(errors(session, kBoomIdentified, {false, true}, 0.1, 0.6).covered(), 0.9);
}

/// What was not followed says nothing of how good a measured torque is.
TEST(GapOfTheCrank, LeavesTheDeviationOfMeasuredTorquesAsItWas) {
  const Session session = withGap(kDisturbed, kGoesOn);
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
