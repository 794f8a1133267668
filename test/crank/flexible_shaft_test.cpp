#include "hammer_loads/crank/flexible_shaft.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr Gravity kSlanting{2.0, -9.6};
constexpr double kDrive = 0.6;  // [kg m2]

ShaftState twistedState(double angle, double speed, double torque) {
  ShaftState s{{0, CrankAngle::fromAngle(angle)}, speed, torque, kDrive};
  s.twist = 0.01;
  s.motor_speed = speed + 1.5;
  return s;
}

class FlexibleShaft : public testing::Test {
 protected:
  ShaftModel modelOf(const Coupling& coupling) const {
    ShaftModel model(mechanism_, Level::kLinkage, coupling);
    model.setHullMotion({kSlanting, 1.0, 20.0});
    return model;
  }
  static ShaftState advanced(const ShaftModel& model, double dt, ShaftState state, const Passing& passing = {}) {
    advanceFlexible(model, dt, passing, state, nullptr);
    return state;
  }

  Mechanism mechanism_{test::mechanismOf(test::mo100LinkageParameters())};
};

/// As a rigid one, see CrankDynamics.
TEST_F(FlexibleShaft, WhereBothSidesPushItBackItPassesAFewTimesOnly) {
  const ShaftModel model = modelOf({50.0, 0.2, 0.03, 0.0, 0.0});
  int most = 0;
  for (const Side side : {Side::kBeforeBlow, Side::kAfterBlow}) {
    for (const double torque : {-100.0, -52.0, -10.0, 10.0, 52.0}) {
      for (const double speed : {-0.1, -0.0158, 0.0158, 0.1}) {
        for (const double dt : {-0.02, 0.005, 0.02}) {
          ShaftState s{{0, {0.0, side}}, speed, torque, kDrive};
          s.motor_speed = speed;
          const int blows = advanceFlexible(model, dt, {}, s, nullptr);
          EXPECT_TRUE(std::isfinite(s.speed));
          most = std::max(most, blows);
        }
      }
    }
  }
  EXPECT_EQ(most, 8);
}

/// Independent: both equations of motion with the coupling's constants from its frequency, the inertia's slope by
/// differences, by boost.odeint. Tolerances: 2e-3 of the twist after ten oscillations, whose phase is wrong by 1e-4 a
/// step.
TEST_F(FlexibleShaft, FollowsTheEquationsOfTwoInertias) {
  for (const double frequency : {30.0, 50.0, 100.0}) {
    for (const double share : {0.2, 0.7}) {
      const ShaftModel model = modelOf({frequency, share, 0.03, 0.0, 0.0});
      const double motor = share * kDrive, crank = kDrive - motor, reduced = 1.0 / (1.0 / motor + 1.0 / crank);
      const double omega = 6.283185307179586 * frequency, k = reduced * omega * omega, c = 2 * 0.03 * reduced * omega;
      using Y = std::array<double, 4>;  // crank angle and speed, motor angle and speed
      const auto rates = [&](const Y& y, Y& r, double) {
        const auto at = [&](double angle) { return model(CrankAngle::fromAngle(angle)); };
        const ShaftLoad load = at(y[0]);
        const double slope = (at(y[0] + 1e-5).inertia - at(y[0] - 1e-5).inertia) / 2e-5;
        const double moment = k * (y[2] - y[0]) + c * (y[3] - y[1]), alpha = load.hull_acceleration;
        r = {y[1], (moment + load.weight_torque - crank * alpha - 0.5 * slope * y[1] * y[1]) / (crank + load.inertia),
             y[3], (120.0 - moment) / motor - alpha};
      };
      const ShaftState from = twistedState(1.0, 20.0, 120.0);
      Y y{1.0, 20.0, 1.01, 21.5};
      namespace odeint = boost::numeric::odeint;
      odeint::integrate_adaptive(odeint::make_controlled(1e-12, 1e-12, odeint::runge_kutta_fehlberg78<Y>()), rates, y,
                                 0.0, 0.1, 1e-4);
      const ShaftState to = advanced(model, 0.1, from);
      EXPECT_NEAR(difference(to.position, from.position), y[0] - 1.0, 2e-5) << frequency << ' ' << share;
      EXPECT_NEAR(to.speed, y[1], 0.01) << frequency << ' ' << share;
      EXPECT_NEAR(to.twist, y[2] - y[0], 2e-5) << frequency << ' ' << share;
      EXPECT_NEAR(to.motor_speed, y[3], 0.01) << frequency << ' ' << share;
    }
  }
}

TEST_F(FlexibleShaft, GoesBackTheWayItCame) {
  const ShaftModel model = modelOf({60.0, 0.4, 0.02, 0.0, 0.0});
  const ShaftState from = twistedState(6.2, 25.0, 150.0);
  const Passing blow{0.8, true};
  const ShaftState back = advanced(model, -0.02, advanced(model, 0.02, from, blow), blow);
  EXPECT_NEAR(difference(back.position, from.position), 0.0, 1e-5);
  EXPECT_NEAR(back.speed, from.speed, 0.005);
  EXPECT_NEAR(back.twist, from.twist, 1e-5);
  EXPECT_NEAR(back.motor_speed, from.motor_speed, 0.005);
}

/// What the blow does acts on the crank alone.
TEST_F(FlexibleShaft, ABlowLeavesTheMotorAlone) {
  const ShaftModel model = modelOf({60.0, 0.4, 0.02, 0.0, 0.0});
  const ShaftState from = twistedState(kTwoPi - 1e-7, 20.0, 150.0), to = advanced(model, 1e-8, from, {0.5, true});
  ASSERT_EQ(to.position.angle.side, Side::kAfterBlow);
  EXPECT_NEAR(to.speed, 0.5 * from.speed, 1e-4);
  EXPECT_NEAR(to.motor_speed, from.motor_speed, 1e-4);
  EXPECT_NEAR(to.twist, from.twist, 1e-6);
}

TEST_F(FlexibleShaft, ItsLinearisationFollowsFiniteDifferences) {
  const Coupling coupling{70.0, 0.3, 0.05, 0.0, 0.0};
  const ShaftModel model = modelOf(coupling);
  const auto damped = [&](double by) {
    Coupling other = coupling;
    other.damping *= std::exp(by);
    return modelOf(other);
  };
  const auto moved = [&](ShaftState s, int i, double by) {
    if (i == 0) s.position.turn(by), s.twist -= by;
    if (i == 1) s.speed += by;
    if (i == 2) s.torque += by;
    if (i == 3) s.drive_inertia *= std::exp(by);
    if (i == kMotorAngle) s.twist += by;
    if (i == kMotorSpeed) s.motor_speed += by;
    if (i == kStiffness) s.log_stiffness += by;
    if (i == kOdds) s.log_odds += by;
    return s;
  };
  const double step[] = {1e-5, 1e-4, 1e-2, 1e-4, 1e-4, 1e-5, 1e-4, 1e-4, 1e-4, 1e-4};
  const double size[] = {1e-3, 0.1, 100.0, 0.1, 0.05, 1e-3, 0.1, 0.1, 0.1, 0.1};  // unit changes that matter
  for (const double angle : {0.5, 2.0, 3.5, 4.8, 5.6, 6.0, 6.2, 6.275}) {
    for (const double dt : {2e-4, 1e-3, 2e-3}) {
      const ShaftState from = twistedState(angle, 18.0, 150.0);
      ShaftState to = from;
      FlexibleMatrix f = FlexibleMatrix::Identity();
      const int blows = advanceFlexible(model, dt, {0.7, true}, to, &f);
      EXPECT_EQ(blows, to.position.blowsPassed() - from.position.blowsPassed());
      for (int i = 0; i <= kDamping; ++i) {
        const auto end = [&](double by) {
          return advanced(i == kDamping ? damped(by) : model, dt, moved(from, i, by),
                          {0.7 + (i == 4 ? by : 0.0), true});
        };
        const ShaftState high = end(step[i]), low = end(-step[i]);
        const double per = size[i] / (2.0 * step[i]), by_angle = difference(high.position, low.position);
        EXPECT_NEAR(f(0, i) * size[i], by_angle * per, 1e-5) << angle << ' ' << dt << ' ' << i;
        EXPECT_NEAR(f(1, i) * size[i], (high.speed - low.speed) * per, 4e-3) << angle << ' ' << dt << ' ' << i;
        EXPECT_NEAR(f(kMotorAngle, i) * size[i], (by_angle + high.twist - low.twist) * per, 1e-5)
            << angle << ' ' << dt << ' ' << i;
        EXPECT_NEAR(f(kMotorSpeed, i) * size[i], (high.motor_speed - low.motor_speed) * per, 4e-3)
            << angle << ' ' << dt << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace hammer_loads
