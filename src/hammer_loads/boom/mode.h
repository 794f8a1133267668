/// One mode of vibration: unit mass, x'' + 2 zeta omega x' + omega^2 x = f, advanced exactly.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

constexpr double kFrequencyDeviation = 0.15;  // bulk modulus +-30 %: what a file can know of oil with air in it
constexpr double kDampingDeviation = 0.5;
// Prior: kFrequencyDeviation, kDampingDeviation

/// Standard deviations of the logarithms of every mode's frequency (half of the bulk modulus's) and damping [-].
struct OilDeviation {
  double frequency{kFrequencyDeviation}, damping{kDampingDeviation};
};

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

/// 1/n!
constexpr auto kInverseFactorial = [] {
  std::array<double, 24> inverse{1.0};
  for (std::size_t n = 1; n < inverse.size(); ++n) inverse[n] = inverse[n - 1] / static_cast<double>(n);
  return inverse;
}();

/// ramp/t^3 and parabola/t^4 by this many terms of their power series sum d_k/(k+3)! and sum d_k/(k+4)!, with x = omega
/// t, d_0 = 1, d_1 = -2 zeta x, d_k = -2 zeta x d_(k-1) - x^2 d_(k-2); |d_k| <= (k + 1) x^k.
template <std::size_t terms>
inline ModeResponse seriesOf(double x, double zeta) noexcept {
  const double p = -2.0 * zeta * x, q = x * x;
  double d = 1.0, before = 0.0;
  ModeResponse r;
  for (std::size_t k = 0; k < terms; ++k) {
    r.ramp += d * kInverseFactorial[k + 3];
    r.parabola += d * kInverseFactorial[k + 4];
    const double next = p * d - q * before;
    before = d;
    d = next;
  }
  return r;
}

inline ModeResponse responseAt(const Mode& mode, double t) noexcept {
  const double w = mode.omega, ww = w * w, damping = 2.0 * mode.zeta * w;
  ModeResponse r;
  if (w * t <= 1.0) {
    // The series is truncated below 1e-18; the equation of motion gives impulse and step.
    constexpr double kShort = 0.25;
    // Numerical: kShort
    r = w * t <= kShort ? seriesOf<12>(w * t, mode.zeta) : seriesOf<20>(w * t, mode.zeta);
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

/// Transition of a mode's state over a step h, and its responses at h.
struct ModeStep {
  ModeResponse r;
  double x_by_x{}, x_by_v{}, v_by_x{}, v_by_v{};
};

inline ModeStep stepOf(const Mode& mode, double h) noexcept {
  ModeStep step;
  const ModeResponse& r = step.r = responseAt(mode, h);
  const double ww = mode.omega * mode.omega;
  step.x_by_x = 1.0 - ww * r.step, step.x_by_v = r.impulse;
  step.v_by_x = -ww * r.impulse, step.v_by_v = step.x_by_x - 2.0 * mode.zeta * mode.omega * r.impulse;
  return step;
}

inline ModeState advancedFreely(const ModeStep& step, const ModeState& now) noexcept {
  return {step.x_by_x * now.x + step.x_by_v * now.v, step.v_by_x * now.x + step.v_by_v * now.v};
}

/// Force on a mode over one step h: from, to its ends, linear between plus a parabola that makes the mean `mean`.
struct ModeForce {
  double from{}, to{}, mean{};
};

/// Force on a mode over one step in the form from + slope t + bend t^2/2.
struct ForcePath {
  double from{}, slope{}, bend{};
};

inline ForcePath pathOf(const ModeForce& force, double h) noexcept {
  const double bump = 6.0 * (force.mean - 0.5 * (force.from + force.to));
  const double per_time = h > 0.0 ? 1.0 / h : 0.0;
  return {force.from, (force.to - force.from + bump) * per_time, -2.0 * bump * per_time * per_time};
}

/// State after a step, exact for that force; for no force its size never grows, whatever the step.
inline ModeState advanced(const ModeStep& step, const ModeState& now, const ForcePath& force) noexcept {
  const ModeResponse& r = step.r;
  ModeState next = advancedFreely(step, now);
  next.x += force.from * r.step + force.slope * r.ramp + force.bend * r.parabola;
  next.v += force.from * r.impulse + force.slope * r.step + force.bend * r.ramp;
  return next;
}

inline ModeState advanced(const Mode& mode, const ModeState& now, const ModeForce& force, double h) noexcept {
  return advanced(stepOf(mode, h), now, pathOf(force, h));
}

/// stepOf() one mode, kept as long as mode and step stay the same.
class KeptStep {
 public:
  const ModeStep& at(const Mode& mode, double h) noexcept {
    if (mode.omega != mode_.omega || mode.zeta != mode_.zeta || h != h_) {
      step_ = stepOf(mode, h);
      mode_ = mode;
      h_ = h;
    }
    return step_;
  }

 private:
  Mode mode_;
  double h_{};
  ModeStep step_;
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
