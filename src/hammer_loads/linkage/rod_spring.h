/// The spring between crank and rocker, and how what hangs on it swings.
#pragma once

#include <cmath>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/sine_cosine.h"

namespace hammer_loads {

/// Rod, pins and bearings as one spring along the rod, its damping, and the joint clearance and friction of the pins.
/// Level elastic models all four; the other levels model none of them.
struct RodSpring {
  double stiffness{};        ///< k [N/m]; 0: not known
  double damping_ratio{};    ///< damping ratio of an oscillator of kReference on k [-]; 0: not known
  double play{};             ///< free way of both pins together [m], >= 0
  double friction_radius{};  ///< radius of a pin's friction circle, coefficient of friction times pin radius [m], >= 0

  static constexpr double kReference = kTwoPi * 200.0;                                      ///< [rad/s]
  double damping() const noexcept { return 2.0 * damping_ratio * stiffness / kReference; }  ///< [N s/m]
};

/// Prior of a connecting rod before any measurement. No source gives values, so estimates replace what a file leaves
/// out.
struct RodPrior {
  RodSpring rod;
  double log_stiffness{}, log_damping{};  ///< standard deviations of their logarithms
  double play{};                          ///< standard deviation [m]
  double friction_radius{};               ///< standard deviation [m]
  bool gives{};                           ///< false: the rod is given as rigid, its pins as tight

  static constexpr double kStiffness = 8e8, kDamping = 0.4;  ///< 4e8 to 1e9 N/m and 0.2 to 0.6: estimates
  static constexpr double kStiffest = 1e11;                  ///< stands for a rigid rod [N/m]
};

/// Standard deviations where a file gives none; 0 in the rod: not known.
inline RodSpring usualDeviation(const RodSpring& rod) noexcept {
  return {rod.stiffness > 0.0 ? 0.2 * rod.stiffness : 0.5 * RodPrior::kStiffness,
          rod.damping_ratio > 0.0 ? 0.4 * rod.damping_ratio : 0.8 * RodPrior::kDamping, 1e-4, 1e-3};
}

/// deviation: standard, in the units of the rod. A stiffness that is neither known nor in doubt is that of a rigid rod.
inline RodPrior priorOf(const RodSpring& rod, const RodSpring& deviation) noexcept {
  RodPrior prior{rod, 0.0, 0.0, deviation.play, deviation.friction_radius, true};
  if (!(rod.stiffness > 0.0)) prior.rod.stiffness = deviation.stiffness > 0.0 ? prior.kStiffness : prior.kStiffest;
  if (!(rod.damping_ratio > 0.0)) prior.rod.damping_ratio = prior.kDamping;
  prior.log_stiffness = deviation.stiffness / prior.rod.stiffness;
  prior.log_damping = deviation.damping_ratio / prior.rod.damping_ratio;
  prior.gives = rod.stiffness > 0.0 || deviation.stiffness > 0.0 || rod.play > 0.0 || deviation.play > 0.0;
  return prior;
}

/// The pins as the readings show them.
struct IdentifiedPins {
  double clearance{};            ///< joint clearance along the rod, of both pins together [m]; 0 if they are tight
  double friction_radius_std{};  ///< standard deviation of RodSpring::friction_radius [m]
};

/// y'' = -square y - 2 decay y', exactly over a time, with any damping.
struct Oscillator {
  double square{};  ///< square of the undamped angular frequency [rad2/s2], > 0
  double decay{};   ///< [1/s], >= 0

  void move(double time, double& y, double& speed) const noexcept {
    const double rest = square - decay * decay, from = y, v = speed;
    double cosine, sine;  // sine over the frequency, both with the decay
    if (rest > 0.0) {
      const double frequency = std::sqrt(rest), e = std::exp(-decay * time);
      const SineCosine at = sineCosine(frequency * time);
      cosine = e * at.cosine, sine = e * at.sine / frequency;
    } else {
      const double s = std::sqrt(-rest);
      const double slow = std::exp((s - decay) * time), fast = std::exp(-(s + decay) * time);
      cosine = 0.5 * (slow + fast), sine = s > 0.0 ? 0.5 * (slow - fast) / s : time * slow;
    }
    y = from * cosine + (v + decay * from) * sine;
    speed = v * cosine - (square * from + decay * v) * sine;
  }
};

}  // namespace hammer_loads
