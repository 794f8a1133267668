#include "hammer_loads/hammer/pulse.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <vector>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::kPaperSpeed;

ConstantSpeedPulse paperPulse() {
  return pulseAtConstantSpeed(test::mechanismOf(test::mo100Parameters()), Level::kRocker, kPaperSpeed, {});
}

TEST(ConstantSpeedPulse, HasThePapersPulseExactly) {
  const ConstantSpeedPulse exact = paperPulse();
  const auto expectNear = [](double value, double right) { EXPECT_NEAR(value, right, 1e-11 * right); };
  expectNear(exact.pulse.amplitude, 40558.0395215);
  expectNear(exact.peak_angle * 180.0 / kPi, 348.480359663);
  expectNear(exact.pulse.impulse, 483.218440034);
  expectNear(exact.pulse.frequency, 167.866273972);
  expectNear(exact.pulse.start, 0.181284679239);
  expectNear(exact.pulse.turn_impulse_z, 534.602622037);
  expectNear(exact.pulse.period, 2.0 * kPi / kPaperSpeed);
  EXPECT_NEAR(exact.pulse.turn_impulse_x, 0.0, 1e-9);
}

TEST(ConstantSpeedPulse, IsNearThePapersFigures) {
  // P0: H = 39 895 N, mu = 170 1/s, t1 = 0.1815 s, by trapezoid from a graph.
  const HalfSinePulse pulse = paperPulse().pulse;
  EXPECT_NEAR(pulse.amplitude, 39895.0, 0.02 * 39895.0);
  EXPECT_NEAR(pulse.frequency, 170.0, 0.015 * 170.0);
  EXPECT_NEAR(pulse.start, 0.1815, 0.0005);
}

/// Returns Fz [N] at constant speed; phi in [0, 2 pi].
double forceZ(const Mechanism& mechanism, Level level, double phi, double w, Gravity gravity) {
  const CrankAngle angle =
      phi < kPi ? CrankAngle{phi, Side::kAfterBlow} : CrankAngle{phi - 2.0 * kPi, Side::kBeforeBlow};
  return hullWrench(mechanism, level, {angle, w, 0.0}, gravity).force_z;
}

TEST(ConstantSpeedPulse, ImpulsesAndResidualEqualQuadrature) {
  std::mt19937 random(61);
  for (int i = 0; i < 6; ++i) {
    const Mechanism mechanism =
        test::mechanismOf(i == 0 ? test::mo100LinkageParameters() : test::randomParameters(random));
    for (Level level : {Level::kRocker, Level::kLinkage}) {
      const double w = 20.0;
      const Gravity gravity{2.0, -9.6};
      const HalfSinePulse pulse = pulseAtConstantSpeed(mechanism, level, w, gravity).pulse;
      const auto integral = [&](auto value) {  // over the revolution, by time
        constexpr int kSteps = 40000;          // midpoints
        double sum = 0.0;
        for (int k = 0; k < kSteps; ++k) sum += value(2.0 * kPi * (k + 0.5) / kSteps);
        return sum * 2.0 * kPi / kSteps / w;
      };
      const double scale = pulse.amplitude * pulse.period;
      EXPECT_NEAR(pulse.turn_impulse_z, integral([&](double phi) { return forceZ(mechanism, level, phi, w, gravity); }),
                  1e-6 * scale);
      const double square = integral([&](double phi) {
        const double t = phi / w;
        const double sine = t > pulse.start ? pulse.amplitude * std::sin(pulse.frequency * (t - pulse.start)) : 0.0;
        return std::pow((forceZ(mechanism, level, phi, w, gravity) - sine) / pulse.amplitude, 2);
      });
      EXPECT_NEAR(pulse.half_sine_rms_error, std::sqrt(square / pulse.period), 1e-5);
    }
  }
}

TEST(ConstantSpeedPulse, FindsTheHighestPointAndTheLastRiseOfAnyMachine) {
  std::mt19937 random(62);
  for (int i = 0; i < 12; ++i) {
    const Mechanism mechanism = test::mechanismOf(test::randomParameters(random));
    for (Level level : {Level::kRocker, Level::kLinkage}) {
      for (Gravity gravity : {Gravity{}, Gravity{0.0, -9.8}}) {
        const double w = 15.0;
        const ConstantSpeedPulse found = pulseAtConstantSpeed(mechanism, level, w, gravity);
        constexpr int kSteps = 30000;
        double highest = -1e300, at = 0.0;
        for (int k = 0; k <= kSteps; ++k) {
          const double phi = 2.0 * kPi * k / kSteps;
          const double f = forceZ(mechanism, level, phi, w, gravity);
          if (f > highest) highest = f, at = phi;
        }
        EXPECT_GE(found.pulse.amplitude, highest - 1e-15 * std::abs(highest));
        EXPECT_LE(found.pulse.amplitude, highest + 1e-5 * std::abs(highest));
        EXPECT_NEAR(found.peak_angle, at, 2.0 * kPi / kSteps);
        EXPECT_GE(found.pulse.start, -1e300);
      }
    }
  }
}

TEST(ConstantSpeedPulse, LobeWithoutAZeroBeginsWithTheTurn) {
  // The hull hangs upside down. The weight of the slow rocker acts along +z in the whole revolution.
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const double w = 0.01;
  const HalfSinePulse pulse = pulseAtConstantSpeed(mechanism, Level::kRocker, w, {0.0, 9.8}).pulse;
  EXPECT_NEAR(pulse.impulse, pulse.turn_impulse_z, 1e-9 * pulse.impulse);
  EXPECT_NEAR(pulse.impulse, 35.2 * 9.8 * pulse.period, 1e-3 * pulse.impulse);
  EXPECT_TRUE(std::isfinite(pulse.start));
}

TEST(ConstantSpeedPulse, HasNoPulseWithoutAPositiveForce) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HalfSinePulse pulse = pulseAtConstantSpeed(mechanism, Level::kRocker, 0.01, {0.0, -9.8}).pulse;
  EXPECT_LT(pulse.amplitude, 0.0);
  EXPECT_EQ(pulse.impulse, 0.0);
  EXPECT_EQ(pulse.frequency, 0.0);
  EXPECT_EQ(pulse.start, pulse.period);
}

/// Returns points of MO-100's revolution at constant speed. Steps differ from the mean by up to this part of it.
std::vector<TurnPoint> turnPoints(double mean_step, double unevenness, Gravity gravity) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const double w = kPaperSpeed, period = 2.0 * kPi / w;
  const LinkMomentum begin = linkMomentum(mechanism, Level::kRocker, {0.0, Side::kAfterBlow}, w);
  std::mt19937 random(63);
  std::uniform_real_distribution<> shift(1.0 - unevenness, 1.0 + unevenness);
  std::vector<TurnPoint> points;
  for (double t = 0.0;; t = std::min(t + mean_step * shift(random), period)) {
    const double phi = w * t;
    const CrankAngle angle = t >= period ? CrankAngle{0.0, Side::kBeforeBlow}
                             : phi < kPi ? CrankAngle{phi, Side::kAfterBlow}
                                         : CrankAngle{phi - 2.0 * kPi, Side::kBeforeBlow};
    const LinkMomentum now = linkMomentum(mechanism, Level::kRocker, angle, w);
    points.push_back({t, hullWrench(mechanism, Level::kRocker, {angle, w, 0.0}, gravity).force_z,
                      begin.x - now.x + 35.2 * gravity.x * t, begin.z - now.z + 35.2 * gravity.z * t});
    if (t >= period) return points;
  }
}

TEST(PulseOfTurn, ApproachesTheExactPulseWithFinerPoints) {
  const HalfSinePulse exact = paperPulse().pulse;
  struct Case {
    double step, amplitude, impulse;
  };
  for (const Case& c :
       {Case{0.5e-3, 1e-4, 1e-5}, Case{1e-3, 1e-3, 2e-5}, Case{5e-3, 0.05, 2e-3}, Case{10e-3, 0.2, 1e-2}}) {
    const std::vector<TurnPoint> points = turnPoints(c.step, 0.4, {});
    const HalfSinePulse pulse = pulseOfTurn(points.data(), points.size());
    EXPECT_NEAR(pulse.amplitude, exact.amplitude, c.amplitude * exact.amplitude) << c.step;
    EXPECT_NEAR(pulse.impulse, exact.impulse, c.impulse * exact.impulse) << c.step;
    EXPECT_NEAR(pulse.peak_time, exact.peak_time, 0.5 * c.step) << c.step;
    EXPECT_NEAR(pulse.turn_impulse_z, exact.turn_impulse_z, 1e-9) << "exact however sparse";
    EXPECT_NEAR(pulse.turn_impulse_x, 0.0, 1e-9);
    EXPECT_EQ(pulse.period, points.back().time);
    EXPECT_NEAR(pulse.half_sine_rms_error, exact.half_sine_rms_error, 0.5 * exact.half_sine_rms_error) << c.step;
  }
}

TEST(PulseOfTurn, SmallRippleAtTheEndStartsNoLobe) {
  std::vector<TurnPoint> points = turnPoints(1e-3, 0.0, {0.0, -9.8});
  const HalfSinePulse clean = pulseOfTurn(points.data(), points.size());
  points[points.size() - 3].force_z = -50.0;
  points[points.size() - 2].force_z = 60.0;
  const HalfSinePulse rippled = pulseOfTurn(points.data(), points.size());
  EXPECT_NEAR(rippled.impulse, clean.impulse, 1e-12 * clean.impulse);
}

TEST(PulseOfTurn, PeakAtTheTurnsEndIsTakenAsItIs) {
  const TurnPoint points[] = {
      {0.0, -1.0, 0.0, 0.0}, {0.1, 0.0, 0.0, -0.05}, {0.2, 1.0, 0.0, 0.0}, {0.3, 2.0, 0.0, 0.15}};
  const HalfSinePulse pulse = pulseOfTurn(points, 4);
  EXPECT_EQ(pulse.amplitude, 2.0);
  EXPECT_EQ(pulse.peak_time, 0.3);
  EXPECT_NEAR(pulse.impulse, 0.2, 1e-15);
}

TEST(PulseOfTurn, HandlesFlatNegativeAndTooShortTracks) {
  const TurnPoint flat[] = {{0.0, 1.0, 0.0, 0.0}, {0.1, 1.0, 0.0, 0.1}, {0.2, 1.0, 0.0, 0.2}};
  const HalfSinePulse lobe = pulseOfTurn(flat, 3);
  EXPECT_EQ(lobe.amplitude, 1.0);
  EXPECT_NEAR(lobe.impulse, 0.2, 1e-15);
  EXPECT_NEAR(lobe.frequency, 10.0, 1e-12);
  const TurnPoint negative[] = {{0.0, -1.0, 0.0, 0.0}, {0.1, -2.0, 0.0, -0.1}, {0.2, -1.5, 0.0, -0.3}};
  const HalfSinePulse none = pulseOfTurn(negative, 3);
  EXPECT_EQ(none.impulse, 0.0);
  EXPECT_EQ(none.start, none.period);
  EXPECT_EQ(none.turn_impulse_z, -0.3);
  EXPECT_EQ(pulseOfTurn(flat, 2).period, 0.0);
}

/// Two samples of a sensor may be almost simultaneous. Their forces differ by the second one's correction.
TEST(PulseOfTurn, TwoPointsTogetherGiveNoFalsePeak) {
  constexpr double kPeak = 8000.0, kTurn = 0.2, kStep = 1e-3;
  std::vector<TurnPoint> points;
  for (int i = 0; i <= 200; ++i) {
    const double time = i * kStep, arc = kPi * time / kTurn;
    points.push_back({time, kPeak * std::sin(arc), 0.0, kPeak * kTurn / kPi * (1.0 - std::cos(arc))});
  }
  const double clean = pulseOfTurn(points.data(), points.size()).amplitude;
  EXPECT_NEAR(clean, kPeak, 1.0);
  for (const double apart : {2e-9, 1e-7, 1e-5}) {
    for (const double higher : {-20.0, 20.0}) {
      std::vector<TurnPoint> pair = points;
      TurnPoint second = pair[100];
      second.time += apart;
      second.force_z += higher;
      pair.insert(pair.begin() + 101, second);
      EXPECT_NEAR(pulseOfTurn(pair.data(), pair.size()).amplitude, kPeak, 25.0) << apart << ' ' << higher;
    }
  }
}

}  // namespace
}  // namespace hammer_loads
