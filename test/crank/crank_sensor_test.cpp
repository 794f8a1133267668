#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

/// The contract's formula, as it stands there.
double readingOf(const CrankSensorPlace& p, double angle) {
  double seen = angle;
  for (int n = 1; n <= 2; ++n) {
    const double a = p.eccentricity[n - 1], phase = p.eccentricity_phase[n - 1];
    seen += a * (std::sin(n * angle + phase) - std::sin(phase));
  }
  return p.zero + p.direction * p.ratio * seen;
}

CrankSensorPlace randomPlace(std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  CrankSensorPlace p;
  p.zero = 20.0 * (part(random) - 0.5);
  p.direction = part(random) < 0.5 ? 1 : -1;
  const double steepest = 0.98 * part(random), first = part(random);
  p.eccentricity[0] = steepest * first;
  p.eccentricity[1] = 0.5 * steepest * (1.0 - first);
  p.eccentricity_phase[0] = 10.0 * part(random);
  p.eccentricity_phase[1] = 10.0 * part(random);
  return p;
}

TEST(CrankSensor, ChangesNothingWithoutAnyKey) {
  for (const CrankSensor& sensor : {CrankSensor(), *CrankSensor::make({}).value}) {
    EXPECT_TRUE(sensor.isIdentity());
    for (const double x : {0.0, -0.0, 1e-300, 6.2, -1e9, 123456.789}) {
      EXPECT_EQ(sensor.angle(x), x);
      EXPECT_EQ(std::signbit(sensor.angle(x)), std::signbit(x));
      EXPECT_EQ(sensor.speed(1.0, x), x);
    }
    EXPECT_TRUE(std::isnan(sensor.angle(std::nan(""))));
  }
}

TEST(CrankSensor, InvertsTheContractsFormula) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> turns(-3.0, 3.0);
  for (int i = 0; i < 20000; ++i) {
    const CrankSensorPlace place = randomPlace(random);
    const CrankSensor sensor = *CrankSensor::make(place).value;
    const double angle = kTwoPi * turns(random), reading = readingOf(place, angle);
    // The reading's rounding, times how flat it is.
    const double slope = std::abs(readingOf(place, angle + 1e-5) - readingOf(place, angle - 1e-5)) / 2e-5;
    ASSERT_NEAR(sensor.angle(reading), angle, 1e-14 + 2e-14 / slope);
    ASSERT_NEAR(sensor.reading(angle), reading, 1e-13);
  }
}

TEST(CrankSensor, ManyTurnsStayExact) {
  CrankSensorPlace place;
  place.eccentricity[0] = 0.02;
  place.eccentricity_phase[0] = 0.7;
  place.zero = 0.5;
  const CrankSensor sensor = *CrankSensor::make(place).value;
  for (const double turn : {1e3, 1e6, -1e6}) {
    const double one = sensor.angle(2.0), many = sensor.angle(2.0 + kTwoPi * turn);
    EXPECT_NEAR(many - kTwoPi * turn, one, 4e-16 * std::abs(kTwoPi * turn) + 1e-14);
  }
}

TEST(CrankSensor, SpeedIsTheReadingsDerivativeTurnedBack) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 200; ++i) {
    const CrankSensorPlace place = randomPlace(random);
    const CrankSensor sensor = *CrankSensor::make(place).value;
    const double angle = 0.031 * i, speed = 40.0, h = 1e-5;
    const double measured = speed * (readingOf(place, angle + h) - readingOf(place, angle - h)) / (2.0 * h);
    ASSERT_NEAR(sensor.speed(angle, measured), speed, 1e-5);
  }
}

TEST(CrankSensor, ReadsAGearedEncoder) {
  CrankSensorPlace place;
  place.ratio = 2.5;
  place.direction = -1;
  place.zero = 0.3;
  const CrankSensor sensor = *CrankSensor::make(place).value;
  EXPECT_NEAR(sensor.angle(readingOf(place, 11.0)), 11.0, 1e-13);
  EXPECT_NEAR(sensor.speed(0.0, -25.0), 10.0, 1e-14);
}

TEST(CrankSensor, ImpossiblePlacesAreRefused) {
  const auto problemsOf = [](auto change) {
    CrankSensorPlace place;
    change(place);
    const Checked<CrankSensor> made = CrankSensor::make(place);
    EXPECT_EQ(made.value.has_value(), made.problems.empty());
    return made.problems;
  };
  EXPECT_EQ(problemsOf([](auto& p) { p.direction = 0; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.direction = 2; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.ratio = 0.0; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.ratio = -1.0; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.eccentricity[0] = -0.1; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.eccentricity[0] = 1.0; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.eccentricity[1] = 0.5; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.ratio = 2.0, p.eccentricity[1] = 0.1; }).size(), 1U);
  EXPECT_EQ(problemsOf([](auto& p) { p.direction = 3, p.ratio = 0.0; }).size(), 2U);
  EXPECT_TRUE(problemsOf([](auto& p) { p.eccentricity[0] = 0.9; }).empty());
}

}  // namespace
}  // namespace hammer_loads
