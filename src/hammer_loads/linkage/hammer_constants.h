/// Table of a hammer's nominal parameters, one row each, for hammer file, standard deviations and columns.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

struct HammerConstant {
  const char* key;                           ///< key in the hammer file
  const char* unit;                          ///< unit at the end of the key
  double& (*field)(HammerParameters&);       ///< in SI, an angle in rad
  double (*usual)(const HammerParameters&);  ///< standard deviation where the file gives none, in the field's unit
  double away;                               ///< 1 or -1: direction in which a deviation leads to a possible hammer
  enum class Enters {
    kMotion,   ///< motion of the links, and with it the loads
    kLoads,    ///< the loads of a given motion
    kBlow,     ///< the blow alone
    kLearned,  ///< no column: the crank's filter estimates it better
    kFollows,  ///< no column: it follows from other constants
  } enters;
  enum class Sign { kAny, kNotNegative, kPositive } sign;  ///< sign that a possible hammer has
  bool optional{};  ///< a hammer file may leave it out; then the default of HammerParameters is used
};

namespace constant {

template <double LinkLengths::*member>
double& of(HammerParameters& p) {
  return p.lengths.*member;
}
template <double HammerParameters::*member>
double& of(HammerParameters& p) {
  return p.*member;
}

inline double exact(const HammerParameters&) { return 0.0; }
inline double length(const HammerParameters&) { return 3e-4; }
inline double centre(const HammerParameters&) { return 1e-3; }
inline double centreAngle(const HammerParameters& p) { return centre(p) / p.rocker_com_distance; }
/// Mass and inertia of the rocker, which is weighed.
template <double HammerParameters::*member>
double weighed(const HammerParameters& p) {
  return 0.02 * p.*member;
}
/// Masses of crank and connecting rod, which data sheets rarely give.
template <double HammerParameters::*member>
double guessed(const HammerParameters& p) {
  return 0.5 * std::abs(p.*member);
}

}  // namespace constant

inline constexpr std::size_t kHammerConstantCount = std::tuple_size_v<HammerDeviations>;

/// Constants in the order of the file, the lengths first. For absent standard deviations see the contract.
inline constexpr std::array<HammerConstant, kHammerConstantCount> kHammerConstants = [] {
  using namespace constant;
  using P = HammerParameters;
  using L = LinkLengths;
  using Enters = HammerConstant::Enters;
  using Sign = HammerConstant::Sign;
  return std::array<HammerConstant, kHammerConstantCount>{{
      {"crank_length_m", "m", of<&L::crank>, length, -1.0, Enters::kMotion, Sign::kPositive},
      {"rod_length_m", "m", of<&L::rod>, exact, 1.0, Enters::kFollows, Sign::kPositive},
      {"rocker_length_m", "m", of<&L::rocker>, length, 1.0, Enters::kMotion, Sign::kPositive},
      {"pivot_distance_m", "m", of<&L::pivot_distance>, length, 1.0, Enters::kMotion, Sign::kPositive},
      {"rocker_com_distance_m", "m", of<&P::rocker_com_distance>, centre, -1.0, Enters::kLoads, Sign::kPositive},
      {"rocker_com_angle_deg", "deg", of<&P::rocker_com_angle>, centreAngle, 1.0, Enters::kLoads, Sign::kAny},
      {"rocker_mass_kg", "kg", of<&P::rocker_mass>, weighed<&P::rocker_mass>, -1.0, Enters::kLoads, Sign::kPositive},
      {"rocker_inertia_about_pivot_kg_m2", "kg m2", of<&P::rocker_inertia_about_pivot>,
       weighed<&P::rocker_inertia_about_pivot>, 1.0, Enters::kLoads, Sign::kPositive},
      {"striking_distance_m", "m", of<&P::striking_distance>, length, 1.0, Enters::kBlow, Sign::kPositive},
      {"striking_offset_m", "m", of<&P::striking_offset>, exact, 1.0, Enters::kBlow, Sign::kAny, true},
      {"striking_friction", "", of<&P::striking_friction>, exact, 1.0, Enters::kBlow, Sign::kNotNegative, true},
      {"crank_mass_kg", "kg", of<&P::crank_mass>, guessed<&P::crank_mass>, 1.0, Enters::kLoads, Sign::kNotNegative},
      {"crank_com_along_m", "m", of<&P::crank_com_along>, guessed<&P::crank_com_along>, 1.0, Enters::kLoads,
       Sign::kAny},
      {"crank_com_across_m", "m", of<&P::crank_com_across>, guessed<&P::crank_com_across>, 1.0, Enters::kLoads,
       Sign::kAny},
      {"crank_inertia_about_com_kg_m2", "kg m2", of<&P::crank_inertia_about_com>, guessed<&P::crank_inertia_about_com>,
       1.0, Enters::kLoads, Sign::kNotNegative},
      {"rod_mass_kg", "kg", of<&P::rod_mass>, guessed<&P::rod_mass>, 1.0, Enters::kLoads, Sign::kNotNegative},
      {"rod_com_along_m", "m", of<&P::rod_com_along>, guessed<&P::rod_com_along>, 1.0, Enters::kLoads, Sign::kAny},
      {"rod_com_across_m", "m", of<&P::rod_com_across>, guessed<&P::rod_com_across>, 1.0, Enters::kLoads, Sign::kAny},
      {"rod_inertia_about_com_kg_m2", "kg m2", of<&P::rod_inertia_about_com>, guessed<&P::rod_inertia_about_com>, 1.0,
       Enters::kLoads, Sign::kNotNegative},
      {"drive_inertia_kg_m2", "kg m2", of<&P::drive_inertia>, exact, 1.0, Enters::kLearned, Sign::kPositive},
      {"drive_reaction_ratio", "", of<&P::drive_reaction_ratio>, exact, 1.0, Enters::kLoads, Sign::kAny, true},
  }};
}();

/// Returns a constant's value in the unit of its key.
inline double inFile(const HammerConstant& constant, double value) {
  return std::string(constant.unit) == "deg" ? value / kDegree : value;
}

/// Returns the index of a key in kHammerConstants, if it is there.
inline std::optional<std::size_t> indexOfConstant(const std::string& key) {
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i)
    if (kHammerConstants[i].key == key) return i;
  return std::nullopt;
}

/// Key of the constant's standard deviation: `_std` before the unit.
inline std::string deviationKey(const HammerConstant& constant) {
  std::string key = constant.key, unit = constant.unit;
  for (char& c : unit)
    if (c == ' ') c = '_';
  const std::string end = unit.empty() ? "" : "_" + unit;
  return key.substr(0, key.size() - end.size()) + "_std" + end;
}

/// Default standard deviations of the constants, used where a hammer file gives none.
inline HammerDeviations usualDeviations(const HammerParameters& parameters) {
  HammerDeviations deviations{};
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) deviations[i] = kHammerConstants[i].usual(parameters);
  return deviations;
}

}  // namespace hammer_loads
