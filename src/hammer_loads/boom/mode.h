/// One mode of vibration: unit mass, x'' + 2 zeta omega x' + omega^2 x = f, advanced exactly.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

struct Mode {
  double omega{};  ///< natural frequency [rad/s], >= 0
  double zeta{};   ///< damping ratio [-], in [0, 1)
};

struct ModeState {
  double x{};  ///< displacement [m sqrt(kg)]
  double v{};  ///< velocity [m sqrt(kg)/s]
};

/// Displacement at time t after rest at 0 by an impulse, a step, a ramp t and a parabola t^2/2; each is the integral of
/// the one before. Relative error some 1e-15 for any omega t.
struct ModeResponse {
  double impulse{}, step{}, ramp{}, parabola{};
};

/// 1/n: a division would cost as much as the rest of a term.
constexpr auto kInverse = [] {
  std::array<double, 24> inverse{};
  for (std::size_t n = 1; n < inverse.size(); ++n) inverse[n] = 1.0 / static_cast<double>(n);
  return inverse;
}();

inline ModeResponse responseAt(const Mode& mode, double t) noexcept {
  const double w = mode.omega, ww = w * w, damping = 2.0 * mode.zeta * w;
  ModeResponse r;
  if (w * t <= 1.0) {
    // Power series of ramp = t^3 sum c_k (wt)^k/(k+3)! and parabola = t^4 sum c_k (wt)^k/(k+4)!, with c_0 = 1,
    // c_1 = -2 zeta, c_k = -2 zeta c_(k-1) - c_(k-2); |c_k| <= k + 1. The equation of motion gives the others.
    const double x = w * t;
    double term = 1.0 / 6.0, c = 1.0, c_before = 0.0;  // term = x^k/(k+3)!
    for (std::size_t k = 0; k < 20; ++k) {
      const double next = term * kInverse[k + 4];
      r.ramp += c * term;
      r.parabola += c * next;
      term = x * next;
      if (static_cast<double>(k + 2) * term < 1e-18) break;
      const double c_next = -2.0 * mode.zeta * c - c_before;
      c_before = c;
      c = c_next;
    }
    r.ramp *= t * t * t;
    r.parabola *= t * t * t * t;
    r.step = 0.5 * t * t - damping * r.ramp - ww * r.parabola;
    r.impulse = t - damping * r.step - ww * r.ramp;
    return r;
  }
  const double root = std::sqrt((1.0 - mode.zeta) * (1.0 + mode.zeta));
  const double decay = std::exp(-mode.zeta * w * t), c = std::cos(root * w * t), s = std::sin(root * w * t);
  r.impulse = decay * s / (root * w);
  r.step = (1.0 - decay * (c + mode.zeta / root * s)) / ww;
  r.ramp = (t - damping * r.step - r.impulse) / ww;
  r.parabola = (0.5 * t * t - damping * r.ramp - r.step) / ww;
  return r;
}

/// State after a step h without force; r = responseAt(mode, h).
inline ModeState advancedFreely(const Mode& mode, const ModeState& now, const ModeResponse& r) noexcept {
  const double ww = mode.omega * mode.omega;
  const double kept = 1.0 - ww * r.step;  // displacement kept by an initial displacement 1
  return {kept * now.x + r.impulse * now.v,
          -ww * r.impulse * now.x + (kept - 2.0 * mode.zeta * mode.omega * r.impulse) * now.v};
}

/// Force on a mode over one step h: from, to its ends, linear between plus a parabola that makes the mean `mean`.
struct ModeForce {
  double from{}, to{}, mean{};
};

/// State after step h [s], exact for that force; for no force its size never grows, whatever the step. r =
/// responseAt(mode, h).
inline ModeState advanced(const Mode& mode, const ModeState& now, const ModeForce& force, double h,
                          const ModeResponse& r) noexcept {
  const double bump = 6.0 * (force.mean - 0.5 * (force.from + force.to));
  const double slope = h > 0.0 ? (force.to - force.from + bump) / h : 0.0;
  const double bend = h > 0.0 ? -2.0 * bump / (h * h) : 0.0;
  ModeState next = advancedFreely(mode, now, r);
  next.x += force.from * r.step + slope * r.ramp + bend * r.parabola;
  next.v += force.from * r.impulse + slope * r.step + bend * r.ramp;
  return next;
}

inline ModeState advanced(const Mode& mode, const ModeState& now, const ModeForce& force, double h) noexcept {
  return advanced(mode, now, force, h, responseAt(mode, h));
}

/// responseAt() of one mode, kept as long as mode and step stay the same.
class KeptResponse {
 public:
  const ModeResponse& at(const Mode& mode, double step) noexcept {
    if (mode.omega != mode_.omega || mode.zeta != mode_.zeta || step != step_) {
      response_ = responseAt(mode, step);
      mode_ = mode;
      step_ = step;
    }
    return response_;
  }

 private:
  Mode mode_;
  double step_{};
  ModeResponse response_;
};

/// [m kg/s2] per sqrt(kg), for the force acting at that instant.
inline double acceleration(const Mode& mode, const ModeState& state, double force) noexcept {
  return force - 2.0 * mode.zeta * mode.omega * state.v - mode.omega * mode.omega * state.x;
}

/// State at time t >= 0 after rest, under the half-sine pulse amplitude sin(mu t), 0 < t < pi/mu, and free after it.
/// Closed form; zeta > 0 or omega != mu. Error some 1e-15/(zeta + |1 - omega/mu|) of the response's size.
inline ModeState halfSineResponse(const Mode& mode, double amplitude, double mu, double t) noexcept {
  const double length = kPi / mu, pulse_time = std::fmin(t, length);
  const double difference = (mode.omega - mu) * (mode.omega + mu);
  const double damping = 2.0 * mode.zeta * mode.omega * mu;
  const double size = amplitude / (difference * difference + damping * damping);
  const double in_phase = size * difference, behind = -size * damping;  // steady: in_phase sin + behind cos
  const double s = std::sin(mu * pulse_time), c = std::cos(mu * pulse_time);
  ModeState state = advanced(mode, {-behind, -in_phase * mu}, {}, pulse_time);
  state.x += in_phase * s + behind * c;
  state.v += mu * (in_phase * c - behind * s);
  return t > length ? advanced(mode, state, {}, t - length) : state;
}

}  // namespace hammer_loads
