#include "hammer_loads/crank/crank_dynamics.h"

#include <gtest/gtest.h>

#include <boost/numeric/odeint.hpp>
#include <vector>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr Gravity kLeaning{2.0, -9.6};

ShaftState stateAt(double angle, double speed, double torque, double inertia = 0.6) {
  return {{0, CrankAngle::fromAngle(angle)}, speed, torque, inertia};
}

ShaftState advanced(const ShaftModel& model, double dt, ShaftState state) {
  ShaftLoad load = model(state.position.angle);
  advance(model, dt, state, load);
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

TEST_F(CrankDynamics, EnergyGrowsByTheWorkOfTorqueAndWeight) {
  rocker_.setHullMotion(kLeaning);
  const auto height = [&](const ShaftState& s) {  // potential of the weight: minus m g . r
    const Motion m = motion(mechanism_.linkage(), s.position.angle);
    const double ls = mechanism_.parameters().rocker_com_distance;
    return -mechanism_.parameters().rocker_mass * (-kLeaning.x * ls * m.cos_psi + kLeaning.z * ls * m.sin_psi);
  };
  const ShaftState from = stateAt(0.3, 20.0, 90.0), to = advanced(rocker_, 0.12, from);
  const double work = 90.0 * difference(to.position, from.position) - (height(to) - height(from));
  EXPECT_NEAR((kineticEnergy(rocker_, to) - kineticEnergy(rocker_, from)) / work, 1.0, 1e-7);
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

TEST_F(CrankDynamics, GoesBackTheWayItCame) {
  for (const double dt : {0.01, 0.05, 0.1}) {
    const ShaftState from = stateAt(5.7, 25.0, 150.0);
    const ShaftState back = advanced(rocker_, -dt, advanced(rocker_, dt, from));
    EXPECT_NEAR(difference(back.position, from.position), 0.0, 1e-5) << dt;
    EXPECT_NEAR(back.speed, from.speed, 1e-3) << dt;
  }
}

TEST_F(CrankDynamics, ReversesAndTurnsBackwardsThroughTheBlow) {
  const ShaftState reversed = advanced(rocker_, 0.2, stateAt(1.0, 3.0, -40.0));
  EXPECT_LT(reversed.speed, 0.0);
  const ShaftState through = advanced(rocker_, 0.02, stateAt(0.1, -20.0, 0.0));
  EXPECT_EQ(through.position.angle.side, Side::kBeforeBlow);
  EXPECT_EQ(through.position.blow, 0);
}

class CrankLinearisation : public CrankDynamics, public testing::WithParamInterface<HullMotion> {};

TEST_P(CrankLinearisation, FollowsFiniteDifferences) {
  linkage_.setHullMotion(GetParam());
  for (const double angle : {0.5, 2.0, 3.5, 4.8, 5.6, 6.0, 6.2, 6.275}) {
    for (const double dt : {2e-4, 1e-3}) {
      const ShaftState from = stateAt(angle, 18.0, 150.0);
      ShaftState to = from;
      ShaftLoad load = linkage_(from.position.angle);
      const ShaftTransition f = advance(linkage_, dt, to, load);
      const double step[] = {1e-5, 1e-4, 1e-2, 1e-4};
      // Unit changes that matter: 1 mrad, 0.1 rad/s, 100 N m, 10 % of inertia.
      const double size[] = {1e-3, 0.1, 100.0, 0.1};
      for (int i = 0; i < 4; ++i) {
        const auto moved = [&](double by) {
          ShaftState s = from;
          if (i == 0) s.position.turn(by);
          if (i == 1) s.speed += by;
          if (i == 2) s.torque += by;
          if (i == 3) s.drive_inertia *= std::exp(by);
          return advanced(linkage_, dt, s);
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

INSTANTIATE_TEST_SUITE_P(Hulls, CrankLinearisation,
                         testing::Values(HullMotion(kLeaning), HullMotion{{5.0, -25.0}, 2.0, 80.0}));

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

TEST(CrankPosition, PassesABlowOnlyWhenItIsAtOrBehindIt) {
  CrankPosition p{3, {-0.01, Side::kBeforeBlow}};
  EXPECT_EQ(p.blowsPassed(), 2);
  p.turn(0.02);
  EXPECT_EQ(p.blowsPassed(), 3);
  EXPECT_EQ(p.blow, 3);
  p.turn(-0.02);
  EXPECT_EQ(p.blowsPassed(), 2);
}

}  // namespace
}  // namespace hammer_loads
