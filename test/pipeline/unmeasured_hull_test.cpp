/// Blows of hammers whose hull swings on its boom and has no IMU, against hull and hammer as one free system.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "hammer_loads/pipeline/hull_state.h"
#include "support/free_run.h"
#include "support/mo100.h"
#include "support/rigid_impact.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::kMs;

struct SwingingMachine {
  HammerParameters hammer;
  test::HullBody body;
  double torque{};  ///< drive torque [N m]
};

/// Draws a machine whose tool is at the centre of percussion: a blow does not change the hull's velocity.
SwingingMachine drawnSwing(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const double size = between(0.75, 1.2), heavy = std::pow(size, 3.0);
  SwingingMachine m;
  HammerParameters& p = m.hammer = test::mo100Parameters();
  p.lengths.crank *= size * between(0.95, 1.05), p.lengths.rocker *= size * between(0.95, 1.05);
  p.lengths.pivot_distance *= size;
  p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  p.rocker_mass *= heavy, p.rocker_com_distance *= size;
  const double first_moment = p.rocker_mass * p.rocker_com_distance;
  p.rocker_inertia_about_pivot = between(1.6, 2.1) * first_moment * p.rocker_com_distance;
  p.striking_distance = p.rocker_inertia_about_pivot / first_moment;
  p.drive_inertia *= heavy * size * size;
  m.torque = 160.0 * heavy * size * size * between(0.7, 1.1);
  m.body.mass = between(7.0, 22.0) * p.rocker_mass, m.body.inertia = 0.15 * m.body.mass;
  const double w = kTwoPi * std::exp(between(std::log(0.7), std::log(8.0))), ratio = between(0.03, 0.12);
  const double mass = m.body.mass + p.rocker_mass, inertia = m.body.inertia + 0.0925 * m.body.mass;
  m.body.stiffness = w * w * Eigen::Vector3d(mass, mass, inertia);
  m.body.damping = 2.0 * ratio * w * Eigen::Vector3d(mass, mass, inertia);
  p.hull_mass = between(0.75, 1.25) * m.body.mass, p.hull_mass_std = 0.25 * m.body.mass;
  return m;
}

struct SwingFigure {
  double squares{}, stated{};
  int count{}, within{};
  void add(double error, double deviation) {
    if (std::isnan(error)) return;
    ++count, within += std::abs(error) <= 2.0 * deviation;
    squares += error * error, stated += deviation * deviation;
  }
};

struct SwingErrors {
  SwingFigure energy, restitution, impulse;  ///< relative errors; absolute for the restitution
};

struct TrueBlow {
  double time{}, energy{}, restitution{}, impulse{};
};

/// Returns the blow from the state at most a step later: crank speed by its acceleration, hull velocity unchanged.
TrueBlow trueBlow(const SwingingMachine& m, const test::FreeRun& run, double time) {
  const test::FreeState s = run.state();
  const double since = s.crank.offset / s.crank_speed, reach = m.hammer.striking_distance;
  const double w = s.crank_speed - since * run.result().acceleration[3];
  const double before = test::transferAtBlow(m.hammer, false) * w, after = test::transferAtBlow(m.hammer, true) * w;
  const double hull =
      s.hull_rate[0] * std::sin(s.hull[2]) + s.hull_rate[1] * std::cos(s.hull[2]) + reach * s.hull_rate[2];
  const double impulse = m.hammer.rocker_inertia_about_pivot * (after - before) / reach;
  return {time - since, -impulse * (0.5 * reach * (before + after) + hull), -after / before, impulse};
}

void followSwing(const SwingingMachine& m, const std::string& hull_motion, std::uint64_t seed, SwingErrors& errors) {
  constexpr double kFrom = 3.0;
  constexpr int kSamples = 7000;
  const Mechanism mechanism = test::mechanismOf(m.hammer);
  const test::FreeHull system(mechanism, Level::kRocker, m.body);
  test::FreeRun run(system, test::hangingStill(m.body, 15.0), m.torque);
  Pipeline pipeline(mechanism, test::settingsWith("hull_motion: " + hull_motion + "\n", false).pipeline);
  std::mt19937_64 random(seed);
  std::normal_distribution<> noise(0.0, 0.15);
  std::vector<TrueBlow> blows;
  int struck = 0;
  for (int i = 0; i < kSamples; ++i, run.advance(1e-3)) {
    const test::FreeState s = run.state();
    if (run.blows() > struck) blows.push_back(trueBlow(m, run, 1e-3 * i)), struck = run.blows();
    const double angle = s.crank.offset + (s.crank.side == Side::kBeforeBlow ? kTwoPi : 0.0);
    const CrankSample sample{std::floor(angle / test::kEncoderCount) * test::kEncoderCount,
                             s.crank_speed + noise(random)};
    const SampleResult& result = pipeline.crankSample(i * kMs, sample);
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const TurnEnd& end = result.ends[k];
      const double time = 1e-9 * static_cast<double>(end.stamp);
      for (const TrueBlow& b : blows) {
        if (time < kFrom || std::abs(b.time - time) > 0.02) continue;
        errors.energy.add(end.blow.energy / b.energy - 1.0, end.blow.energy_std / b.energy);
        errors.restitution.add(end.blow.restitution - b.restitution, end.blow.restitution_std);
        errors.impulse.add(end.blow.tool_impulse_z / b.impulse - 1.0,
                           end.blow_errors.tool_impulse_z.deviation() / b.impulse);
      }
    }
  }
}

/// most: largest ratio of the stated standard deviation to the rms error.
void expectHonest(const SwingFigure& f, const char* name, double most) {
  std::printf("%s: %d of %d blows within two deviations, rms error %.4f, stated %.4f\n", name, f.within, f.count,
              std::sqrt(f.squares / f.count), std::sqrt(f.stated / f.count));
  EXPECT_GE(f.within, 0.88 * f.count) << name;
  EXPECT_LE(f.stated, most * most * f.squares) << name;
}

TEST(UnmeasuredHull, TheDeviationsOfABlowHoldTheHullsVelocity) {
  SwingErrors errors;
  for (std::uint64_t seed = 900; seed < 912; ++seed) followSwing(drawnSwing(seed), "unmeasured", seed, errors);
  EXPECT_GT(errors.energy.count, 150);
  expectHonest(errors.energy, "energy", 3.0);
  expectHonest(errors.restitution, "restitution", 3.0);
  expectHonest(errors.impulse, "tool impulse", 4.0);  // ratio 3.4 with the crank alone
}

TEST(UnmeasuredHull, AHullThatIsHeldHasNoPartOfIt) {
  SwingErrors free, held;
  followSwing(drawnSwing(920), "unmeasured", 1, free);
  followSwing(drawnSwing(920), "fixed", 1, held);
  EXPECT_LT(held.energy.stated, 0.25 * free.energy.stated);
  EXPECT_EQ(held.energy.within, 0);
}

}  // namespace
}  // namespace hammer_loads
