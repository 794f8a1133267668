#include "hammer_loads/linkage/crank_rocker.h"

#include <cmath>
#include <utility>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Largest accepted miss of the change-point condition, relative to the crank (model.md 2).
constexpr double kChangePointTolerance = 1e-3;

}  // namespace

Checked<CrankRocker> CrankRocker::make(const LinkLengths& given) {
  Checked<CrankRocker> result;
  const std::pair<const char*, double> named[] = {{"crank_length_m", given.crank},
                                                  {"rod_length_m", given.rod},
                                                  {"rocker_length_m", given.rocker},
                                                  {"pivot_distance_m", given.pivot_distance}};
  for (const auto& [key, value] : named) {
    if (!(value >= kLeastParameter && value <= kMostParameter)) {
      result.problems.push_back(
          format("%s: %.9g m, must be > 0, from %g to %g", key, value, kLeastParameter, kMostParameter));
    }
  }
  if (!result.problems.empty()) return result;

  const double l0 = given.pivot_distance, l1 = given.crank, l3 = given.rocker;
  const double miss = given.rod - (l0 + l3 - l1);
  if (!(std::abs(miss) <= kChangePointTolerance * l1)) {
    result.problems.push_back(format(
        "rod_length_m: impossible linkage: |crank + rod - pivot distance - rocker| = |%.9g + %.9g - %.9g - %.9g| = "
        "%.6g m, must be <= 1e-3 crank lengths = %.6g m (change-point condition)",
        l1, given.rod, l0, l3, std::abs(miss), kChangePointTolerance * l1));
  }
  if (!(l1 < l0)) {
    result.problems.push_back(
        format("crank_length_m: %.9g m, must be < pivot_distance_m = %.9g m or the crank cannot turn", l1, l0));
  }
  if (!(l1 < l3)) {
    result.problems.push_back(
        format("crank_length_m: %.9g m, must be < rocker_length_m = %.9g m or the crank cannot turn", l1, l3));
  }
  if (!result.problems.empty()) return result;

  CrankRocker linkage;
  linkage.lengths_ = given;
  linkage.lengths_.rod = l0 + l3 - l1;
  const double correction = linkage.lengths_.rod - given.rod;
  if (std::abs(correction) > 1e-12 * l1) {
    result.notes.push_back(
        format("rod_length_m: %.12g m corrected by %.3g m to %.12g m, so that crank + rod = pivot distance + rocker",
               given.rod, correction, linkage.lengths_.rod));
  }
  Ratios& k = linkage.ratios_;
  k.lambda0 = l0 / l1;
  k.lambda3 = l3 / l1;
  k.lambda2 = linkage.lengths_.rod / l1;
  const double lambda0_less_1 = (l0 - l1) / l1;
  const double lambda3_less_1 = (l3 - l1) / l1;
  k.sigma = (l0 + l3) / l1;
  k.g = k.sigma * lambda3_less_1 / k.lambda0;
  k.two_over_r0_squared = 2.0 * k.lambda0 / (k.lambda2 * k.lambda3);
  k.k_cos = k.lambda3 * lambda0_less_1;
  k.k_sin = k.lambda0 * lambda3_less_1;
  k.w0 = k.lambda2 * lambda0_less_1 / k.lambda0;
  k.lambda0_squared = k.lambda0 * k.lambda0;
  k.lambda3_squared = k.lambda3 * k.lambda3;
  k.lambda03 = k.lambda0 * k.lambda3;
  k.sigma_squared = k.sigma * k.sigma;
  k.sigma_k_cos = k.sigma * k.k_cos;
  k.sigma_k_sin = k.sigma * k.k_sin;
  k.sigma_w0 = k.sigma * k.w0;
  k.sigma_lambda2_less_1 = k.sigma * (k.lambda2 - 1.0);
  k.lambda3_sigma = k.lambda3 * k.sigma;
  k.lambda3_over_sigma_squared = k.lambda3 / k.sigma_squared;
  result.value = linkage;
  return result;
}

}  // namespace hammer_loads
