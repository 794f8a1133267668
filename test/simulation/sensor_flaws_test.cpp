// Flaws of the simulated machine's crank sensor: each has its specified effect, and nothing else changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "hammer_loads/util/constants.h"
#include "simulation/flawed_run.h"

namespace hammer_loads::simulation {
namespace {

using test::flawedRun;

double since(const MachineSettings& s, const CrankReading& reading) {
  return 1e-9 * static_cast<double>(reading.stamp - s.start_stamp);
}

TEST(Stamps, FlawsOfTheMessagesLeaveMachineAndReadingsAsTheyAre) {
  MachineSettings flawed = flawedRun();
  flawed.crank.stamp_noise = 3e-4;
  flawed.crank.stamps_late = true;
  flawed.crank.stamp_step = 1e-3;
  flawed.crank.latency = 2e-3;
  const Session plain = recordSession(flawedRun()), other = recordSession(flawed);
  ASSERT_EQ(plain.crank.size(), other.crank.size());
  for (std::size_t i = 0; i < plain.crank.size(); ++i) {
    ASSERT_EQ(plain.crank[i].angle, other.crank[i].angle);
    ASSERT_EQ(plain.crank[i].speed, other.crank[i].speed);
    ASSERT_EQ(plain.taken[i], other.taken[i]);
  }
}

/// The truth of a header stamp is that of a reading actually taken then.
TEST(Stamps, TruthIsThatOfTheStampLessTheLatency) {
  MachineSettings s = flawedRun();
  s.crank.stamp_noise = 3e-4;
  s.crank.latency = 4e-3;
  s.blow = {true, 0.0, 0.3, 0.0, 0.0, 50.0, 0.0};
  const Session session = recordSession(s);
  MachineSettings exact = s;
  exact.crank.stamp_noise = exact.crank.latency = 0.0;
  const Session taken = recordSession(exact);
  double largest = 0.0;
  for (std::size_t i = 3000; i < session.crank.size(); ++i) {
    const double t = since(s, session.crank[i]) - s.crank.latency;
    ASSERT_NEAR(session.truth[i].time, t, 2e-9);
    // Extrapolated from the reading's own truth by its speed and acceleration, away from the blow.
    const CrankTruth& at = taken.truth[i];
    const double dt = t - at.time;
    if (session.truth[i].turn != at.turn || std::abs(std::remainder(at.angle, kTwoPi)) < 0.1) continue;
    const double moved = at.angle + dt * (at.speed + 0.5 * dt * at.acceleration);
    largest = std::max(largest, std::abs(session.truth[i].angle - moved));
  }
  EXPECT_LT(largest, 1e-4);
}

/// Stamps of a Husky's odometry (robot_localization, test/test1.bag; 3952 messages at 10 Hz) about their own line, in
/// intervals: standard deviation 0.0314; quantiles of 1, 50 and 99 %: -0.057, 0.000 and 0.053.
TEST(Stamps, EqualThoseOfARealPolledDriver) {
  MachineSettings s = flawedRun();
  s.crank.rate = 1000.0;
  s.crank.driver.tick = 0.108 / s.crank.rate;
  const Session session = recordSession(s);
  std::vector<double> late;
  for (std::size_t i = 0; i < session.crank.size(); ++i)
    late.push_back(1000.0 * (since(s, session.crank[i]) - session.taken[i]));
  const double n = static_cast<double>(late.size()), mean = std::accumulate(late.begin(), late.end(), 0.0) / n;
  double squares = 0.0;
  for (double& each : late) each -= mean, squares += each * each;
  std::sort(late.begin(), late.end());
  const auto quantile = [&](double part) { return late[static_cast<std::size_t>(part * n)]; };
  EXPECT_NEAR(std::sqrt(squares / n), 0.0314, 0.002);
  EXPECT_NEAR(quantile(0.01), -0.057, 0.005);
  EXPECT_NEAR(quantile(0.5), 0.0, 0.005);
  EXPECT_NEAR(quantile(0.99), 0.053, 0.005);
}

TEST(Stamps, AreLateNowAndThenOnEveryTopic) {
  MachineSettings s = flawedRun();
  const Session plain = recordSession(s);
  s.crank.driver = s.boom_stamps = {0.0, 0.1, 5e-3};
  const Session session = recordSession(s);
  const auto check = [](const auto& readings, const auto& exact) {
    ASSERT_EQ(readings.size(), exact.size());
    double late = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const double by = 1e-9 * static_cast<double>(readings[i].stamp - exact[i].stamp);
      ASSERT_GE(by, 0.0);
      late += by > 0.0, sum += by;
    }
    const double n = static_cast<double>(readings.size());
    EXPECT_NEAR(late / n, 0.1, 4.0 * std::sqrt(0.09 / n));
    EXPECT_NEAR(sum / late, 5e-3, 4.0 * 5e-3 / std::sqrt(late));
  };
  check(session.crank, plain.crank);
  check(session.joints, plain.joints);
}

/// The encoder shows the mean of the last readings of a controller's task, at the instants of that task.
TEST(Encoder, ShowsTheLastMeanOfAController) {
  MachineSettings s = flawedRun();
  s.crank.rate = 100.0;
  s.crank.counts = 0;
  s.crank.jitter = 0.0;
  s.crank.unwound = true;
  s.crank.task_period = 4e-3;
  s.crank.task_mean = 2;
  const Session session = recordSession(s);
  std::vector<double> tasks;
  for (int i = 0; 4e-3 * i <= s.duration; ++i) tasks.push_back(4e-3 * i);
  const std::vector<CrankTruth> truth = truthAt(s, tasks);
  const auto angle = [&](std::size_t i) { return kTwoPi * static_cast<double>(truth[i].turn) + truth[i].angle; };
  ASSERT_GT(session.crank.size(), 700U);
  for (std::size_t i = 100; i < session.crank.size(); ++i) {
    const auto last = static_cast<std::size_t>(std::floor(session.taken[i] / 4e-3 + 1e-6));
    ASSERT_NEAR(session.crank[i].angle, 0.5 * (angle(last) + angle(last - 1)), 1e-6) << i;
  }
}

TEST(Encoder, StaysBehindEitherWayWithHysteresis) {
  MachineSettings s = flawedRun();
  s.crank.counts = 0;
  const Session plain = recordSession(s);
  s.crank.hysteresis = 2e-3;
  const Session session = recordSession(s);
  double least = 1.0, most = -1.0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const double off = std::remainder(session.crank[i].angle - plain.crank[i].angle, kTwoPi);
    least = std::min(least, off), most = std::max(most, off);
  }
  EXPECT_NEAR(least, -1e-3, 1e-9);
  EXPECT_GT(most, 0.0);
  EXPECT_LT(most, 1e-3 + 1e-9);
}

TEST(Encoder, ReadingIsTheContractsFormula) {
  MachineSettings s = flawedRun();
  s.crank.counts = 0;
  s.crank.unwound = true;
  s.crank.speed_noise = 0.0;
  s.crank.zero = 0.7;
  s.crank.direction = -1;
  s.crank.eccentricity[0] = {0.03, 0.4};
  s.crank.eccentricity[1] = {0.01, -1.1};
  const Session session = recordSession(s);
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const CrankTruth& t = session.truth[i];
    const double phi = t.angle + kTwoPi * static_cast<double>(t.turn);
    const auto reading = [](double a) {
      return 0.7 - (a + 0.03 * (std::sin(a + 0.4) - std::sin(0.4)) + 0.01 * (std::sin(2 * a - 1.1) - std::sin(-1.1)));
    };
    ASSERT_NEAR(session.crank[i].angle, reading(phi), 1e-12);
    ASSERT_NEAR(*session.crank[i].speed, t.speed * (reading(phi + 1e-5) - reading(phi - 1e-5)) / 2e-5, 1e-6);
  }
}

TEST(Encoder, GearedOneCountsItsOwnTurns) {
  MachineSettings s = flawedRun();
  s.crank.ratio = 2.5;
  s.crank.counts = 1024;
  const Session session = recordSession(s);
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const CrankTruth& t = session.truth[i];
    const double turned = 2.5 * (t.angle + kTwoPi * static_cast<double>(t.turn));
    const double behind = std::remainder(turned - session.crank[i].angle, kTwoPi);
    ASSERT_GE(behind, -1e-9);
    ASSERT_LE(behind, kTwoPi / 1024 + 1e-9);
    ASSERT_GE(session.crank[i].angle, 0.0);
    ASSERT_LT(session.crank[i].angle, kTwoPi);
  }
}

/// Integrates the filter's equation, lag y' = speed - y, in small Euler steps.
TEST(Encoder, FilteredSpeedsObeyTheFiltersEquation) {
  MachineSettings s = flawedRun();
  s.crank.speed_noise = 0.0;
  s.crank.speed_lag = 5e-3;
  s.crank.speed_scale = 1.05;
  const Session session = recordSession(s);
  MachineSettings fine = flawedRun();
  fine.crank.rate = 50000.0;
  fine.crank.jitter = fine.crank.speed_noise = 0.0;
  fine.duration = 3.0;
  const Session plain = recordSession(fine);
  double y = 0.0, largest = 0.0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < plain.truth.size(); ++i) {
    const double time = plain.truth[i].time;
    while (next < session.truth.size() && session.truth[next].time <= time) {
      if (time > 1.0) largest = std::max(largest, std::abs(*session.crank[next].speed - 1.05 * y));
      ++next;
    }
    y += 2e-5 / s.crank.speed_lag * (plain.truth[i].speed - y);
  }
  EXPECT_LT(largest, 0.05);  // error of Euler's method: half a step at 800 rad/s2, and the change in a step
  EXPECT_GT(next, 2000U);
}

TEST(Encoder, SlipsByItsAmountForItsTime) {
  MachineSettings s = flawedRun();
  const Session plain = recordSession(s);
  s.crank.slip = {0.1, {4.0, 6.0}};
  const Session session = recordSession(s);
  ASSERT_EQ(plain.crank.size(), session.crank.size());
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const bool slipped = session.truth[i].time >= 4.0 && session.truth[i].time < 6.0;
    const double off = std::remainder(session.crank[i].angle - plain.crank[i].angle, kTwoPi);
    ASSERT_NEAR(off, slipped ? 0.1 : 0.0, kTwoPi / 4096 + 1e-9);
  }
}

}  // namespace
}  // namespace hammer_loads::simulation
