#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/simulation/session.h"
#include "support/constants.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kMaxSpeed = 300.0;

struct Sensor {
  double angle_unit{1.0}, speed_unit{1.0};
  bool speed{true};
};

/// Result of a check for degrees: found at any time, and found at the end of the session.
struct Verdict {
  bool ever{}, last{};
  std::size_t first{};  ///< index of the first sample with this result
};

Verdict judge(const simulation::Session& session, const Sensor& sensor, UnitCheck& check) {
  Verdict verdict;
  std::int64_t last = 0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankReading& r = session.crank[i];
    std::optional<double> speed;
    if (sensor.speed && r.speed) speed = *r.speed * sensor.speed_unit;
    check.add(1e-9 * static_cast<double>(r.stamp - last), r.angle * sensor.angle_unit, speed);
    last = r.stamp;
    if (check.isOtherUnit() && !verdict.ever) verdict = {true, false, i};
  }
  verdict.last = check.isOtherUnit();
  return verdict;
}

Verdict judge(const simulation::Session& session, const Sensor& sensor) {
  UnitCheck check(kMaxSpeed);
  return judge(session, sensor, check);
}

simulation::MachineSettings unwoundMachine(std::uint64_t seed, double rate) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.seed = seed;
  machine.duration = 4.5;
  machine.drive.stop_time = 4.2;
  machine.step = 1e-4;
  machine.crank.rate = rate;
  machine.crank.unwound = seed % 2 == 0;
  return machine;
}

TEST(UnitCheck, DetectsDegreesOfAngleOfSpeedAndOfBoth) {
  for (const double rate : {50.0, 5000.0}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const simulation::Session session = simulation::recordSession(unwoundMachine(seed, rate));
      for (const Sensor& sensor :
           {Sensor{test::kDegreesPerRadian, 1.0, true}, Sensor{1.0, test::kDegreesPerRadian, true},
            Sensor{test::kDegreesPerRadian, test::kDegreesPerRadian, true},
            Sensor{test::kDegreesPerRadian, 1.0, false}}) {
        SCOPED_TRACE(testing::Message() << rate << " Hz, angle x " << sensor.angle_unit << ", speed x "
                                        << (sensor.speed ? sensor.speed_unit : 0.0) << ", seed " << seed);
        const Verdict verdict = judge(session, sensor);
        EXPECT_TRUE(verdict.ever);
        EXPECT_TRUE(verdict.last);
        EXPECT_LT(static_cast<double>(verdict.first) / rate, 3.0) << "the machine works from 2 s on";
      }
    }
  }
}

TEST(UnitCheck, IsSilentOnEverySimulatedSession) {
  for (const double rate : {20.0, 100.0, 1000.0, 20000.0}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      constexpr int kCounts[] = {0, 4096, 512};
      simulation::MachineSettings machine = unwoundMachine(seed, rate);
      machine.crank.counts = kCounts[seed - 1];
      machine.crank.speed_noise = seed == 3 ? 1.0 : 0.15;
      machine.crank.stamp_noise = seed == 3 ? 2e-5 : 0.0;
      const simulation::Session session = simulation::recordSession(machine);
      EXPECT_FALSE(judge(session, {}).ever) << rate << ' ' << seed;
      EXPECT_FALSE(judge(session, {1.0, 1.0, false}).ever) << rate << ' ' << seed;
    }
  }
}

TEST(UnitCheck, ConcludesNothingFromGarbage) {
  UnitCheck check(kMaxSpeed);
  std::mt19937 random(7);
  std::uniform_real_distribution<> any(-1e4, 1e4);
  for (int i = 0; i < 100000; ++i) {
    const double garbage[] = {any(random), std::nan(""), INFINITY, 1e308, -1e308, 5e-324};
    check.add(1e-6 * any(random), garbage[random() % 6], random() % 2 ? std::make_optional(any(random)) : std::nullopt);
    ASSERT_FALSE(check.isOtherUnit()) << i;
  }
}

}  // namespace
}  // namespace hammer_loads
