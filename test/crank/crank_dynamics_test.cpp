#include "hammer_loads/crank/crank_dynamics.h"

#include <gtest/gtest.h>

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <vector>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr Gravity kLeaning{2.0, -9.6};

ShaftState stateAt(double angle, double speed, double torque, double inertia = 0.6) {
  return {{0, CrankAngle::fromAngle(angle)}, speed, torque, inertia};
}

ShaftState advanced(const ShaftModel& model, double dt, ShaftState state, const Passing& passing = {}) {
  ShaftLoad load = model(state.position.angle);
  advance(model, dt, passing, state, load);
  return state;
}

double kineticEnergy(const ShaftModel& model, const ShaftState& s) {
  return 0.5 * (s.drive_inertia + model(s.position.angle).inertia) * s.speed * s.speed;
}

class CrankDynamics : public testing::Test {
 protected:
  Mechanism mechanism_{test::mechanismOf(test::mo100LinkageParameters())};
  ShaftModel rocker_{mechanism_, Level::kRocker};
  ShaftModel linkage_{mechanism_, Level::kLinkage};
};

TEST_F(CrankDynamics, AFreeTurnKeepsItsEnergyUpToTheBlow) {
  for (const ShaftModel& model : {rocker_, linkage_}) {
    ShaftState s = stateAt(0.2, 25.0, 0.0);
    const double energy = kineticEnergy(model, s);
    for (int i = 0; i < 400 && s.position.blow < 1; ++i) s = advanced(model, 1e-3, s);
    while (s.position.angle.side == Side::kBeforeBlow && s.position.angle.offset < -0.02) {
      s = advanced(model, 1e-3, s);
      ASSERT_NEAR(kineticEnergy(model, s) / energy, 1.0, 1e-7);
    }
  }
}

/// A crank that rests on the tool and whose encoder is 1 mrad off creeps over the blow where both sides push it back.
/// It passed 4096 times in one step; a sample took 0.3 s.
TEST_F(CrankDynamics, PassesAFewTimesOnlyWhereBothSidesPushItBack) {
  int most = 0;
  for (const ShaftModel& model : {rocker_, linkage_}) {
    for (const Side side : {Side::kBeforeBlow, Side::kAfterBlow}) {
      for (const double torque : {-100.0, -52.0, -10.0, 10.0, 52.0}) {
        for (const double dt : {-0.02, -0.005, 0.005, 0.02}) {
          ShaftState s{{0, {0.0, side}}, std::copysign(0.0158, dt), torque, 0.6};
          ShaftLoad load = model(s.position.angle);
          const int blows = advance(model, dt, {}, s, load).blows;
          EXPECT_LE(blows, kMostCreepingPasses);
          EXPECT_LT(std::abs(s.position.angle.offset), 0.05);
          EXPECT_TRUE(std::isfinite(s.speed));
          most = std::max(most, blows);
        }
      }
    }
  }
  EXPECT_EQ(most, 8) << "what there is to bound";
}

/// Independent: w' = (tau - dT/dphi...)/..., with the inertia's slope by differences, integrated by boost.odeint.
TEST_F(CrankDynamics, AgreesWithAnotherIntegratorOfTheEquationOfMotion) {
  using Phase = std::vector<double>;
  const auto inertia = [&](double phi) {
    const double u = motion(mechanism_.linkage(), CrankAngle::fromAngle(phi)).u;
    return 0.737 * u * u;
  };
  const auto rate = [&](const Phase& x, Phase& dx, double) {
    constexpr double h = 1e-5;
    const double slope = (inertia(x[0] + h) - inertia(x[0] - h)) / (2 * h);
    dx = {x[1], (150.0 - 0.5 * slope * x[1] * x[1]) / (0.6 + inertia(x[0]))};
  };
  namespace ode = boost::numeric::odeint;
  Phase x{1.0, 30.0};
  ode::integrate_adaptive(ode::make_controlled(1e-11, 1e-11, ode::runge_kutta_dopri5<Phase>()), rate, x, 0.0, 0.1,
                          1e-4);
  const ShaftState s = advanced(rocker_, 0.1, stateAt(1.0, 30.0, 150.0));
  EXPECT_NEAR(difference(s.position, CrankPosition{}), x[0], 1e-6);
  EXPECT_NEAR(s.speed, x[1], 1e-4);
}

TEST_F(CrankDynamics, PassesTheBlowInOneStepAsInMany) {
  const ShaftState from = stateAt(5.9, 16.0, 150.0);
  const ShaftState whole = advanced(rocker_, 0.05, from);
  ShaftState parts = from;
  for (int i = 0; i < 500; ++i) parts = advanced(rocker_, 1e-4, parts);
  EXPECT_EQ(from.position.blowsPassed(), -1);
  EXPECT_EQ(whole.position.blowsPassed(), 0);
  EXPECT_EQ(whole.position.angle.side, Side::kAfterBlow);
  EXPECT_NEAR(difference(whole.position, parts.position), 0.0, 1e-6);
  EXPECT_NEAR(whole.speed, parts.speed, 1e-5);
}

TEST_F(CrankDynamics, ReversesAndTurnsBackwardsThroughTheBlow) {
  const ShaftState reversed = advanced(rocker_, 0.2, stateAt(1.0, 3.0, -40.0));
  EXPECT_LT(reversed.speed, 0.0);
  const ShaftState through = advanced(rocker_, 0.02, stateAt(0.1, -20.0, 0.0));
  EXPECT_EQ(through.position.angle.side, Side::kBeforeBlow);
  EXPECT_EQ(through.position.blow, 0);
}

class CrankLinearisation : public CrankDynamics, public testing::WithParamInterface<HullMotion> {
 protected:
  void follows(double factor);
};

TEST_P(CrankLinearisation, FollowsFiniteDifferences) {
  linkage_.setHullMotion(GetParam());
  for (const double factor : {1.0, 0.7, 1.2}) follows(factor);
}

INSTANTIATE_TEST_SUITE_P(Hulls, CrankLinearisation,
                         testing::Values(HullMotion(kLeaning), HullMotion{{5.0, -25.0}, 2.0, 80.0}));

void CrankLinearisation::follows(double factor) {
  for (const double angle : {0.5, 2.0, 3.5, 4.8, 5.6, 6.0, 6.2, 6.275}) {
    for (const double dt : {2e-4, 1e-3}) {
      const ShaftState from = stateAt(angle, 18.0, 150.0);
      ShaftState to = from;
      ShaftLoad load = linkage_(from.position.angle);
      const Advance result = advance(linkage_, dt, {factor, true}, to, load);
      const ShaftTransition& f = result.transition;
      EXPECT_EQ(result.blows, to.position.blowsPassed() - from.position.blowsPassed());
      const double step[] = {1e-5, 1e-4, 1e-2, 1e-4, 1e-4};
      // Unit changes that matter: 1 mrad, 0.1 rad/s, 100 N m, 10 % of inertia, 5 % of a blow's factor.
      const double size[] = {1e-3, 0.1, 100.0, 0.1, 0.05};
      for (int i = 0; i < 5; ++i) {
        const auto moved = [&](double by) {
          ShaftState s = from;
          if (i == 0) s.position.turn(by);
          if (i == 1) s.speed += by;
          if (i == 2) s.torque += by;
          if (i == 3) s.drive_inertia *= std::exp(by);
          return advanced(linkage_, dt, s, {factor + (i == 4 ? by : 0.0), true});
        };
        const ShaftState high = moved(step[i]), low = moved(-step[i]);
        const double by_angle = difference(high.position, low.position) / (2 * step[i]);
        const double by_speed = (high.speed - low.speed) / (2 * step[i]);
        EXPECT_NEAR(f(0, i) * size[i], by_angle * size[i], 1e-5) << angle << ' ' << dt << ' ' << i;
        EXPECT_NEAR(f(1, i) * size[i], by_speed * size[i], 2e-3) << angle << ' ' << dt << ' ' << i;
      }
    }
  }
}

TEST_F(CrankDynamics, ABlowTakesItsPartOfTheSpeed) {
  for (const double factor : {0.3, 0.8, 1.2}) {
    const ShaftState from = stateAt(kTwoPi - 1e-6, 15.0, 0.0);
    const ShaftState to = advanced(rocker_, 1e-5, from, {factor, true});
    EXPECT_NEAR(to.speed, factor * 15.0, 2e-3) << factor;
    const ShaftState back = advanced(rocker_, -1e-5, to, {factor, true});
    EXPECT_NEAR(back.speed, from.speed, 1e-6) << factor;
  }
}

/// A state that a correction pushed beyond the blow stands where it would, had it passed in time.
TEST_F(CrankDynamics, PassesLateAsInTime) {
  const Passing blow{0.7, true};
  const ShaftState from = stateAt(kTwoPi - 0.004, 15.0, 100.0);
  for (const double late : {1e-5, 5e-5, 2e-4}) {
    ShaftState s = advanced(rocker_, 0.004 / 15.0 + late, from, {1.0, false});
    ASSERT_TRUE(s.position.isMirrored());
    ShaftLoad load;
    ShaftTransition ignored = ShaftTransition::Identity();
    passBlow(rocker_, blow.factor, s, load, ignored);
    const ShaftState in_time = advanced(rocker_, 0.004 / 15.0 + late, from, blow);
    EXPECT_NEAR(difference(s.position, in_time.position), 0.0, 100.0 * late * late + 1e-9) << late;
    EXPECT_NEAR(s.speed, in_time.speed, 1e5 * late * late + 1e-4) << late;
  }
}

/// Without a tool nothing is lost: the rocker swings through, and comes back a turn later.
TEST_F(CrankDynamics, ATurnWithoutContactIsSmoothAndMirrored) {
  ShaftState s = stateAt(5.9, 18.0, 0.0);
  const double energy = kineticEnergy(rocker_, s);
  const auto psi = [&] {
    const Motion m = motion(mechanism_.linkage(), s.position.angle);
    return std::atan2(m.sin_psi, m.cos_psi);
  };
  double last_psi = psi(), lowest = 0.0;
  bool mirrored = false;
  for (int i = 0; i < 6000 && difference(s.position, {}) < 1.9 * kTwoPi; ++i) {
    const double speed = s.speed, u = motion(mechanism_.linkage(), s.position.angle).u;
    s = advanced(rocker_, 1e-4, s, {0.5, false});
    const double mean = 0.5 * (u * speed + motion(mechanism_.linkage(), s.position.angle).u * s.speed);
    ASSERT_NEAR(psi() - last_psi, 1e-4 * mean, 2e-5) << i;
    ASSERT_NEAR(kineticEnergy(rocker_, s) / energy, 1.0, 1e-6) << i;
    last_psi = psi();
    lowest = std::min(lowest, last_psi);
    const double turned = difference(s.position, {});
    if (s.position.angle.offset == 0.0) continue;
    EXPECT_EQ(s.position.isMirrored(), turned > 0.0 && turned < kTwoPi) << turned;
    mirrored |= s.position.isMirrored();
  }
  EXPECT_TRUE(mirrored);
  EXPECT_FALSE(s.position.isMirrored());
  EXPECT_LT(lowest, -2.0);
}

TEST_F(CrankDynamics, AbsurdSpeedsEndInTime) {
  const ShaftState s = advanced(rocker_, 0.1, stateAt(1.0, 1e7, 0.0));
  EXPECT_TRUE(std::isfinite(s.position.angle.offset));
}

TEST(CrankPosition, CountsTurnsWithoutLosingTheAngle) {
  CrankPosition p{0, CrankAngle::fromAngle(1.0)};
  for (int i = 0; i < 1000000; ++i) p.turn(0.75 * kTwoPi);
  EXPECT_EQ(p.blow, 750000);
  EXPECT_NEAR(p.angle.offset, 1.0, 1e-9);
}

}  // namespace
}  // namespace hammer_loads
