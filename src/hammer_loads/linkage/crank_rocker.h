/// Geometry of the change-point crank-rocker: the constants that its motion needs.
#pragma once

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Bounds of the size of every parameter in SI units, the lower one for those that must be > 0: far beyond any hammer,
/// and no product of such numbers overflows.
constexpr double kLeastParameter = 1e-9, kMostParameter = 1e9;

/// Nominal link lengths [m]; pins A (crank on hull), B (crank-rod), C (rod-rocker), D (rocker on hull).
struct LinkLengths {
  double crank{};           ///< l1 = AB [m], > 0, shortest
  double rod{};             ///< l2 = BC [m]
  double rocker{};          ///< l3 = DC [m]
  double pivot_distance{};  ///< l0 = AD [m]
};

/// A crank-rocker that satisfies the change-point condition l1 + l2 = l0 + l3 exactly (P0, "special position"):
/// at crank angle 0 all four pins are in line, and there the rocker strikes.
class CrankRocker {
 public:
  /// Accepts lengths that miss the condition by at most 1e-3 l1 (whole millimetres satisfy it only on paper), corrects
  /// the rod by the difference and notes it; refuses a larger miss, non-positive lengths and a crank that cannot turn.
  static Checked<CrankRocker> make(const LinkLengths& lengths);

  const LinkLengths& lengths() const noexcept { return lengths_; }  ///< rod corrected [m]

  /// Ratios to the crank length and the combinations of them that motion() uses [-]. Differences such as
  /// lambda0 - 1 are formed from the lengths, so no digits are lost when links are nearly equal.
  struct Ratios {
    double lambda0{}, lambda2{}, lambda3{};
    double sigma{};                ///< lambda0 + lambda3 = 1 + lambda2
    double g{};                    ///< r^2 - cos^2(phi/2) = lambda2 lambda3/lambda0 - 1 (P0 (5))
    double two_over_r0_squared{};  ///< 2 lambda0/(lambda2 lambda3); r0 = sqrt(lambda2 lambda3/lambda0)
    double k_cos{}, k_sin{};       ///< lambda3 (lambda0 - 1), lambda0 (lambda3 - 1)
    double w0{};                   ///< lambda2 (lambda0 - 1)/lambda0
    double lambda0_squared{}, lambda3_squared{}, lambda03{};  ///< lambda0^2, lambda3^2, lambda0 lambda3
    double sigma_squared{}, lambda3_sigma{}, lambda3_over_sigma_squared{};
    double sigma_k_cos{}, sigma_k_sin{}, sigma_w0{}, sigma_lambda2_less_1{};  ///< sigma times k_cos, ..., lambda2 - 1
  };
  const Ratios& ratios() const noexcept { return ratios_; }

 private:
  LinkLengths lengths_;
  Ratios ratios_;
};

}  // namespace hammer_loads
