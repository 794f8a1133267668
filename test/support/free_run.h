/// FreeHull at work: its motion under a constant drive torque, through the blows.
#pragma once

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "support/free_hull.h"

namespace hammer_loads::test {

/// A hull of 400 kg on a boom that gives it some 5 Hz, damped by 5 % of critical.
inline HullBody onBoom() {
  HullBody body;
  body.stiffness << 4e5, 4e5, 1e5;
  body.damping << 1.3e3, 1.3e3, 3e2;
  return body;
}

/// So heavy that nothing moves it: a fixed hull with the same weight per mass.
inline HullBody unmoved() {
  HullBody body = onBoom();
  body.com_x = body.com_z = 0.0;
  body.mass = body.inertia = 4e8;
  body.stiffness *= 1e6;
  return body;
}

/// A hull on its boom at rest under its weight and the rocker's, crank just after a blow.
inline FreeState hangingStill(const HullBody& body, double crank_speed) {
  FreeState s;
  s.hull << 0.0, -(body.mass + 35.2) * body.gravity / body.stiffness[1], 0.0;
  s.crank = CrankAngle::fromAngle(0.05);
  s.crank_speed = crank_speed;
  return s;
}

/// Fixed steps of order 8. At the blow the crank keeps its speed; so does the hull, which holds for level rocker and
/// a striking point in the percussion centre (no impulse in D) and is an assumption otherwise.
class FreeRun {
 public:
  FreeRun(const FreeHull& system, const FreeState& start, double torque)
      : system_(&system), torque_(torque), x_{start.hull[0],      start.hull[1],      start.hull[2],
                                              start.hull_rate[0], start.hull_rate[1], start.hull_rate[2],
                                              start.crank.offset, start.crank_speed} {}

  FreeState state() const { return stateOf(x_); }
  FreeHull::Result result() const { return system_->at(state(), torque_); }
  double torque() const { return torque_; }
  int blows() const { return blows_; }

  /// By dt [s], in steps of at most `step`.
  void advance(double dt, double step = 5e-4) {
    for (double left = dt; left > 1e-15;) {
      const double h = std::min(step, left);
      Phase end = stepped(h);
      if (end[kPhi] < kTwoPi) {
        x_ = end;
        left -= h;
        continue;
      }
      double used = h;  // Newton for the blow
      for (int i = 0; i < 8 && std::abs(end[kPhi] - kTwoPi) > 1e-14; ++i) {
        used -= (end[kPhi] - kTwoPi) / end[kSpeed];
        end = stepped(used);
      }
      x_ = end;
      x_[kPhi] = 0.0;
      ++blows_;
      left -= used;
    }
  }

 private:
  enum : std::size_t { kPhi = 6, kSpeed = 7 };
  using Phase = std::array<double, 8>;

  /// Crank angle in [0, 2 pi]; beyond 2 pi the branch before the blow goes on.
  static FreeState stateOf(const Phase& x) {
    const CrankAngle crank = x[kPhi] < 0.5 * kTwoPi ? CrankAngle{x[kPhi], Side::kAfterBlow}
                                                    : CrankAngle{x[kPhi] - kTwoPi, Side::kBeforeBlow};
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, crank, x[kSpeed]};
  }

  Phase stepped(double h) const {
    boost::numeric::odeint::runge_kutta_fehlberg78<Phase> method;
    Phase x = x_;
    method.do_step(
        [this](const Phase& at, Phase& rate, double) {
          const Eigen::Vector4d a = system_->at(stateOf(at), torque_).acceleration;
          rate = {at[3], at[4], at[5], a[0], a[1], a[2], at[kSpeed], a[3]};
        },
        x, 0.0, h);
    return x;
  }

  const FreeHull* system_;
  double torque_;
  Phase x_;
  int blows_{};
};

}  // namespace hammer_loads::test
