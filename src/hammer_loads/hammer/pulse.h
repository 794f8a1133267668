/// Pulse of a revolution: the force along the tool in the form of P0 (15)-(16).
#pragma once

#include <cstddef>

#include "hammer_loads/hammer/hull_wrench.h"

namespace hammer_loads {

/// A rise of Fz through zero counts when the lobe after it reaches this part of the turn's peak, so that ripple near
/// zero starts no lobe.
constexpr double kLeastLobe = 0.1;

/// Fz(t) = H sin(mu (t - t1)) for t1 < t < T after the blow that began the turn, 0 before t1.
/// Deviates: P0 (15) prints sin(mu t); (16) needs the shift (model.md 7).
///
/// The lobe begins with the last rise through zero that counts, or with the turn if there is none. Without a positive
/// lobe (H or Q not positive) mu = 0, t1 = T.
struct HalfSinePulse {
  double period{};               ///< T [s]
  double amplitude{};            ///< H, peak of Fz [N]
  double peak_time{};            ///< time of the peak H after the start of the revolution [s]
  double frequency{};            ///< mu = 2 H/Q [rad/s]
  double start{};                ///< t1 = T - pi/mu [s]; negative when the lobe is longer than half a period of mu
  double impulse{};              ///< Q (P0: S), from Fz's last rise through zero to the blow [N s]
  double turn_impulse_x{};       ///< [N s]
  double turn_impulse_z{};       ///< [N s]
  double half_sine_rms_error{};  ///< rms over the turn of (Fz - half sine)/H [-]
};

/// Point of a revolution. Impulses are exact at any distance of the points.
struct TurnPoint {
  double time{};       ///< after the turn's start [s]
  double force_z{};    ///< [N]
  double impulse_x{};  ///< impulse of the wrench since the start of the revolution, by the difference of momentum [N s]
  double impulse_z{};  ///< impulse along z, likewise [N s]
};

/// Pulse from the points of one whole revolution, in order of strictly growing time, first at time 0 and last at the
/// blow. The distances between the points may differ. Fewer than 3 points give an empty pulse (all zero). The peak
/// between points is found by a parabola (error of H some (mu dt)^3/16 of H), the zero by a line, and the impulse there
/// by the cubic that has the force as its slope. The impulse is stationary at the zero, so that Q is as exact as the
/// points' impulses.
HalfSinePulse pulseOfTurn(const TurnPoint* points, std::size_t count) noexcept;

/// Pulse of a revolution at constant crank speed (as P0 assumes), peak and zero found to rounding (1e-12 of the angle
/// for a regular machine); the impulses are momentum differences. speed > 0 [rad/s].
struct ConstantSpeedPulse {
  HalfSinePulse pulse;
  double peak_angle{};  ///< crank angle of H [rad], in (0, 2 pi)
};
ConstantSpeedPulse pulseAtConstantSpeed(const Mechanism& mechanism, Level level, double speed, Gravity gravity);

}  // namespace hammer_loads
