#include "hammer_loads/linkage/mechanism.h"

#include <cmath>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Largest accepted error of the change-point condition, relative to the crank (model.md 2).
constexpr double kChangePointTolerance = 1e-3;

/// Number of lengths; they come first in kHammerConstants and are checked by CrankRocker::make().
constexpr std::size_t kLengths = 4;

using Sign = HammerConstant::Sign;

void check(const char* key, double value, const char* unit, Sign sign, std::vector<std::string>& problems) {
  const double least = sign == Sign::kPositive ? kLeastParameter : sign == Sign::kNotNegative ? 0.0 : -kMostParameter;
  if (value >= least && value <= kMostParameter) return;
  const char* rule = sign == Sign::kPositive ? "> 0" : sign == Sign::kNotNegative ? ">= 0" : "finite";
  problems.push_back(format("%s: %.9g %s, must be %s, from %g to %g", key, value, unit, rule, least, kMostParameter));
}

double squaredSize(Planar a) { return a.re * a.re + a.im * a.im; }

/// Returns the moments of the links with the corrected rod length.
LinkMoments momentsOf(const HammerParameters& p, const CrankRocker::Ratios& ratios) {
  const Planar to_hull{std::cos(p.rocker_com_angle), -std::sin(p.rocker_com_angle)};
  const Planar crank_com{p.crank_com_along, p.crank_com_across};
  const Planar rod_com{p.rod_com_along, p.rod_com_across};
  const double l1 = p.lengths.crank;
  LinkMoments k;
  k.mass = p.crank_mass + p.rod_mass + p.rocker_mass;
  k.rod_at_b = p.rod_mass * l1 * to_hull;
  k.crank = p.crank_mass * (crank_com * to_hull) + k.rod_at_b;
  k.rod = p.rod_mass * (rod_com * to_hull);
  k.rocker = p.rocker_mass * p.rocker_com_distance;
  k.pivot = p.lengths.pivot_distance * to_hull;
  k.fixed = -(p.crank_mass + p.rod_mass) * k.pivot;
  k.coupling = p.rod_mass * l1 * rod_com;
  k.crank_inertia = p.crank_inertia_about_com + p.crank_mass * squaredSize(crank_com) + p.rod_mass * l1 * l1;
  k.rod_inertia = p.rod_inertia_about_com + p.rod_mass * squaredSize(rod_com);
  k.rod_force_factor = 1.0 / (ratios.two_over_r0_squared * p.lengths.rocker);
  k.rocker_over_rod = p.lengths.rocker / p.lengths.rod;
  k.inv_rod_length = 1.0 / p.lengths.rod;
  return k;
}

}  // namespace

Checked<CrankRocker> CrankRocker::make(const LinkLengths& given) {
  Checked<CrankRocker> result;
  check("crank_length_m", given.crank, "m", Sign::kPositive, result.problems);
  check("rod_length_m", given.rod, "m", Sign::kPositive, result.problems);
  check("rocker_length_m", given.rocker, "m", Sign::kPositive, result.problems);
  check("pivot_distance_m", given.pivot_distance, "m", Sign::kPositive, result.problems);
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
  k.lambda3_sigma = k.lambda3 * k.sigma;
  k.lambda3_over_sigma_squared = k.lambda3 / k.sigma_squared;
  result.value = linkage;
  return result;
}

Checked<Mechanism> Mechanism::make(const HammerParameters& p) {
  Checked<Mechanism> result;
  const Checked<CrankRocker> linkage = CrankRocker::make(p.lengths);
  result.problems = linkage.problems;
  result.notes = linkage.notes;
  HammerParameters copy = p;
  for (std::size_t i = kLengths; i < kHammerConstants.size(); ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    check(constant.key, inFile(constant, constant.field(copy)), constant.unit, constant.sign, result.problems);
  }
  check("rod_damping_ratio", p.rod.damping_ratio, "", Sign::kNotNegative, result.problems);
  check("pin_play_m", p.rod.play, "m", Sign::kNotNegative, result.problems);
  const double least_inertia = p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance;
  if (p.rocker_inertia_about_pivot > 0.0 && p.rocker_inertia_about_pivot < least_inertia) {
    result.problems.push_back(format(
        "rocker_inertia_about_pivot_kg_m2: %.9g kg m2, must be >= rocker mass x centre-of-mass distance^2 = %.9g "
        "kg m2 (about the pivot D, not about the centre of mass)",
        p.rocker_inertia_about_pivot, least_inertia));
  }
  if (p.striking_friction * std::abs(p.striking_offset) >= p.striking_distance && p.striking_distance > 0.0) {
    result.problems.push_back(format(
        "striking_offset_m: %.9g m, times striking_friction must be < striking_distance_m = %.9g m (the tool would jam "
        "the rocker)",
        p.striking_offset, p.striking_distance));
  }
  if (!result.problems.empty()) return result;

  Mechanism mechanism(*linkage.value);
  mechanism.parameters_ = p;
  mechanism.parameters_.lengths = linkage.value->lengths();
  mechanism.moments_ = momentsOf(mechanism.parameters_, mechanism.linkage_.ratios());
  mechanism.cos_com_angle_ = std::cos(p.rocker_com_angle);
  mechanism.sin_com_angle_ = std::sin(p.rocker_com_angle);
  result.value = mechanism;
  return result;
}

}  // namespace hammer_loads
