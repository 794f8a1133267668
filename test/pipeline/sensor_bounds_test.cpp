// Readings of no sensor are refused, and sensors that show what no hull does are not used: each bound and each time
// lies where it is said to be, within a factor of 1.25.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/pipeline/crank_sample_gate.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/hull_pitch.h"
#include "hammer_loads/pipeline/hull_speed.h"
#include "hammer_loads/pipeline/imu_trust.h"
#include "hammer_loads/pipeline/jump_guard.h"
#include "hammer_loads/pipeline/misuse.h"
#include "hammer_loads/pipeline/overdue.h"
#include "hammer_loads/pipeline/pending_blow.h"
#include "hammer_loads/pipeline/pressure_trust.h"
#include "hammer_loads/pipeline/unit_check.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;
constexpr double kBelow = 0.8, kAbove = 1.25;
constexpr double kReadingStep = 1e-3;  // [s] between readings

TEST(SensorBounds, OfCrankAngles) {
  const CrankSampleGate gate({300.0, 0.25, 0.01, 1.5});
  EXPECT_FALSE(gate.refusalOf({kBelow * 1e9, {}}));
  EXPECT_EQ(gate.refusalOf({kAbove * 1e9, {}}), Refusal::kImplausible);
}

TEST(SensorBounds, OfBoomAngles) {
  for (const double part : {kBelow, kAbove}) {
    HullPitch pitch({"boom"}, 0.0);
    pitch.update({"boom"}, {part * 1e4});
    EXPECT_EQ(pitch.refused(), part > 1.0 ? 1U : 0U);
  }
}

TEST(SensorBounds, OfPressures) {
  const auto isTaken = [](double first, double second) {
    CylinderPressures pressures(0.02);
    EXPECT_TRUE(pressures.update(kMs, 0, Chamber::kBore, first));
    return pressures.update(2 * kMs, 0, Chamber::kBore, second);
  };
  EXPECT_TRUE(CylinderPressures(0.02).update(kMs, 0, Chamber::kRod, kBelow * 2e8));
  EXPECT_FALSE(CylinderPressures(0.02).update(kMs, 0, Chamber::kRod, kAbove * 2e8));
  EXPECT_TRUE(isTaken(1e7, 1e7 + kBelow * 5e6));
  EXPECT_FALSE(isTaken(1e7, 1e7 + kAbove * 5e6));
}

TEST(SensorBounds, OfImuReadings) {
  HullImuSettings settings;
  settings.max_age = 0.02;
  const auto first = [&](double force, double rate) {
    return HullImu(settings).update(kMs, {{0.0, 0.0, force}, {0.0, rate, 0.0}});
  };
  EXPECT_FALSE(first(kBelow * 2000.0, kBelow * 100.0));
  EXPECT_EQ(first(kAbove * 2000.0, 0.0), ImuRefusal::kImplausible);
  EXPECT_EQ(first(9.8, kAbove * 100.0), ImuRefusal::kImplausible);
  const auto jump = [&](double force, double rate) {
    HullImu imu(settings);
    imu.update(kMs, {{0.0, 0.0, 9.8}, {0.0, 0.0, 0.0}});
    return imu.update(2 * kMs, {{0.0, 0.0, 9.8 + force}, {0.0, rate, 0.0}});
  };
  EXPECT_FALSE(jump(kBelow * 200.0, kBelow * 3.0));
  EXPECT_EQ(jump(kAbove * 200.0, 0.0), ImuRefusal::kJump);
  EXPECT_EQ(jump(0.0, kAbove * 3.0), ImuRefusal::kJump);
}

/// Readings of the last hundred say how far a reading may jump.
TEST(SensorBounds, OfJumps) {
  JumpGuard guard(1e-9);
  for (int i = 0; i < 3000; ++i) guard.believes(1.0);
  EXPECT_TRUE(JumpGuard(guard).believes(kBelow * 12.0));
  EXPECT_FALSE(JumpGuard(guard).believes(kAbove * 12.0));
  for (int i = 0; i < 100; ++i) guard.believes(0.0);
  const double faded = 12.0 * std::exp(-0.5);
  EXPECT_TRUE(JumpGuard(guard).believes(0.9 * faded));
  EXPECT_FALSE(JumpGuard(guard).believes(1.1 * faded));
}

/// An IMU whose readings alternate by a little: no frozen one.
class ImuOfAHull {
 public:
  /// off: of the mean from the weight's 10 m/s2 [m/s2].
  void run(double time, double off, double rate = 0.0) {
    for (int i = 0; i < std::lround(time / kReadingStep); ++i) {
      const double change = (even_ = !even_) ? 1e-3 : -1e-3;
      trust_.follow({0.0, 0.0, 10.0 - off + change}, {0.0, rate, 0.0}, kReadingStep);
      trust_.judge({0.0, -10.0}, kReadingStep);
    }
  }
  /// One reading again and again.
  void stand(double step, int count) {
    for (int i = 0; i <= count; ++i) {
      trust_.follow({0.0, 0.0, 10.0}, {0.0, 0.0, 0.0}, step);
      trust_.judge({0.0, -10.0}, step);
    }
  }
  bool isLost() const { return trust_.isLost(); }

 private:
  ImuTrust trust_;
  bool even_{};
};

TEST(SensorBounds, OfAnImusMean) {
  const auto isLost = [](double off, double rate) {
    ImuOfAHull imu;
    imu.run(10.0, off, rate);
    return imu.isLost();
  };
  EXPECT_FALSE(isLost(kBelow * 5.0, 0.0));
  EXPECT_TRUE(isLost(kAbove * 5.0, 0.0));
  EXPECT_FALSE(isLost(0.0, kBelow * 3.0));
  EXPECT_TRUE(isLost(0.0, kAbove * 3.0));
}

TEST(SensorBounds, OfAnImusTimes) {
  ImuOfAHull wrong;  // judged after 0.5 s
  wrong.run(0.45, 8.0);
  EXPECT_FALSE(wrong.isLost());
  wrong.run(0.10, 8.0);
  EXPECT_TRUE(wrong.isLost());
  ImuOfAHull later;  // 8 (1 - e^(-t/2)) = 5 m/s2 after 1.96 s
  later.run(10.0, 0.0);
  later.run(1.8, 8.0);
  EXPECT_FALSE(later.isLost());
  later.run(0.3, 8.0);
  EXPECT_TRUE(later.isLost());
  later.run(20.0, 8.0);  // 8 e^(-t/2) = 2.5 m/s2 after 2.33 s
  later.run(2.2, 0.0);
  EXPECT_TRUE(later.isLost());
  later.run(0.3, 0.0);
  EXPECT_FALSE(later.isLost());
}

/// 0.2 s, of which a reading counts for 0.05 s at most.
TEST(SensorBounds, OfAFrozenImu) {
  const auto isLost = [](double step, int count) {
    ImuOfAHull imu;
    imu.run(2.0, 0.0);
    imu.stand(step, count);
    return imu.isLost();
  };
  EXPECT_FALSE(isLost(kReadingStep, 160));
  EXPECT_TRUE(isLost(kReadingStep, 250));
  EXPECT_FALSE(isLost(1.0, 3));
  EXPECT_TRUE(isLost(1.0, 5));
}

/// Pressures beside a weight of 10 N on an arm of 1 m.
class Pressures {
 public:
  void run(double time, double across, double turning, double step = kReadingStep) {
    for (int i = 0; i < std::lround(time / step); ++i)
      trust_.follow({{across, 0.0, 0.0}, {0.0, turning, 0.0}}, {{0.0, 0.0, -10.0}, {0.0, 0.0, 0.0}}, 1.0, step);
  }
  bool isLost() const { return trust_.isLost(); }

 private:
  PressureTrust trust_;
};

TEST(SensorBounds, OfPressuresMean) {
  const auto isLost = [](double across, double turning) {
    Pressures pressures;
    pressures.run(10.0, across, turning);
    return pressures.isLost();
  };
  EXPECT_FALSE(isLost(kBelow * 1.0, kBelow * 3.0));
  EXPECT_TRUE(isLost(kAbove * 1.0, 0.0));
  EXPECT_TRUE(isLost(0.0, kAbove * 3.0));
}

TEST(SensorBounds, OfPressuresTimes) {
  Pressures wrong;  // judged after 0.5 s
  wrong.run(0.4, 2.0, 0.0);
  EXPECT_FALSE(wrong.isLost());
  wrong.run(0.2, 2.0, 0.0);
  EXPECT_TRUE(wrong.isLost());
  Pressures rare;  // of which a sample counts for 0.05 s at most
  rare.run(8.0, 2.0, 0.0, 1.0);
  EXPECT_FALSE(rare.isLost());
  rare.run(4.0, 2.0, 0.0, 1.0);
  EXPECT_TRUE(rare.isLost());
  Pressures later;  // 2 (1 - e^(-t/2)) = 1 N after 1.39 s
  later.run(20.0, 0.0, 0.0);
  later.run(1.1, 2.0, 0.0);
  EXPECT_FALSE(later.isLost());
  later.run(0.7, 2.0, 0.0);
  EXPECT_TRUE(later.isLost());
  later.run(20.0, 2.0, 0.0);  // 2 e^(-t/2) = 0.5 N after 2.77 s
  later.run(2.4, 0.0, 0.0);
  EXPECT_TRUE(later.isLost());
  later.run(0.8, 0.0, 0.0);
  EXPECT_FALSE(later.isLost());
}

TEST(SensorBounds, OfASilentSensor) {
  EXPECT_NEAR(overdue(1.0, 0.4), 0.2, 1e-12);
  EXPECT_NEAR(forgottenPart(0.01), 1.0 - std::exp(-1.0), 1e-12);
  EXPECT_EQ(forgottenPart(-0.01), 0.0);
}

TEST(SensorBounds, OfABlowThatIsMeasured) {
  PendingBlow blow;
  const CrankPosition at{3, {0.0, Side::kAfterBlow}};
  blow.begin(10.0, at, 30.0, 0.0, {});
  const auto isMeasured = [&](double time, double angle) {
    CrankPosition now = at;
    now.angle.offset = angle;
    return blow.isMeasured(10.0 + time, now);
  };
  EXPECT_FALSE(isMeasured(kBelow * 0.2, kBelow * 1.0));
  EXPECT_TRUE(isMeasured(kAbove * 0.2, 0.0));
  EXPECT_TRUE(isMeasured(0.0, kAbove * 1.0));
}

/// The hull's speed at the second of two blows; turn: between them, silent: since the last reading before it [s].
bool knowsSpeed(double turn, double silent) {
  HullSpeed speed;
  const auto stamp = [](double time) { return static_cast<StampNs>(1e9 * time); };
  speed.add(0, 9.8, 0.0, 0.0);
  speed.struck(stamp(0.001));
  for (int i = 2; i <= std::lround((turn - silent) / kReadingStep); ++i)
    speed.add(stamp(kReadingStep * i), 9.8, 0.0, 0.0);
  speed.struck(stamp(0.001 + turn));
  return speed.atBlow().has_value();
}

TEST(SensorBounds, OfTheHullsSpeedAtABlow) {
  EXPECT_TRUE(knowsSpeed(kBelow * 1.0, 0.0));
  EXPECT_FALSE(knowsSpeed(kAbove * 1.0, 0.0));
  EXPECT_TRUE(knowsSpeed(0.2, kBelow * 0.02));
  EXPECT_FALSE(knowsSpeed(0.2, kAbove * 0.02));
}

/// Time for which the hull has been hammering at one place too long; moves by so much after half of it [s].
double stillTime(double time, double move) {
  MisuseFollower misuse;
  misuse.hullAt({0.0, 0.0, 0.0});
  for (int i = 0; i < std::lround(time / 0.25); ++i) {
    if (0.25 * i >= 0.5 * time) misuse.hullAt({move, 0.0, 0.0});
    misuse.blow(0.25);
  }
  return misuse.counts().still_time;
}

TEST(SensorBounds, OfAHullThatStands) {
  EXPECT_EQ(stillTime(kBelow * 15.0, 0.0), 0.0);
  EXPECT_NEAR(stillTime(kAbove * 15.0, 0.0), 3.75, 1e-9);
  EXPECT_GT(stillTime(20.0, kBelow * 0.02), 0.0);
  EXPECT_EQ(stillTime(20.0, kAbove * 0.02), 0.0);
}

/// Whether a crank that turns at `rate` and says `speed` is found to send another unit within the time.
bool looksWrong(double time, double dt, double rate, double speed) {
  UnitCheck check(300.0);
  for (int i = 0; i <= std::lround(time / dt); ++i) check.add(dt, rate * dt * i, speed);
  return check.looksWrong();
}

TEST(SensorBounds, OfUnits) {
  constexpr double kRpm = 60.0 / 6.283185307179586, kDegrees = 360.0 / 6.283185307179586;
  // Degrees: a vote in each millisecond, but 0.2 s of suspicion are required.
  EXPECT_FALSE(looksWrong(kBelow * 0.2, kReadingStep, 20.0 * kDegrees, 20.0));
  EXPECT_TRUE(looksWrong(kAbove * 0.2, kReadingStep, 20.0 * kDegrees, 20.0));
  // Rpm: eight votes, each of a radian that is predicted: 8 rad/4.77 rad/s = 1.68 s.
  EXPECT_FALSE(looksWrong(kBelow * 1.68, kReadingStep, 0.5, 0.5 * kRpm));
  EXPECT_TRUE(looksWrong(kAbove * 1.68, kReadingStep, 0.5, 0.5 * kRpm));
  // The ratio may be off by a factor of 1.4, samples 0.25 s apart.
  EXPECT_TRUE(looksWrong(5.0, kReadingStep, 0.5 / 1.25, 0.5 * kRpm));
  EXPECT_FALSE(looksWrong(5.0, kReadingStep, 0.5 / 1.6, 0.5 * kRpm));
  EXPECT_TRUE(looksWrong(20.0, kBelow * 0.25, 0.5, 0.5 * kRpm));
  EXPECT_FALSE(looksWrong(20.0, kAbove * 0.25, 0.5, 0.5 * kRpm));
}

}  // namespace
}  // namespace hammer_loads
