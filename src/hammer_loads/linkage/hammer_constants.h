/// Table of the constants of a hammer's drawing, one row each, for hammer file, deviations and columns.
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
  bool optional{};  ///< a hammer file may leave it out; then the default of HammerParameters counts
};

namespace usual {

inline double exact(const HammerParameters&) { return 0.0; }
inline double length(const HammerParameters&) { return 3e-4; }
constexpr double kCentre = 1e-3;   // [m]
constexpr double kWeighed = 0.02;  // relative, for the rocker's mass and inertia
constexpr double kGuessed = 0.5;   // relative, for masses of crank and connecting rod, which data sheets rarely give

}  // namespace usual

inline constexpr std::size_t kHammerConstantCount = std::tuple_size_v<HammerDeviations>;

/// In the order of the file. Absent deviations: contract.
inline constexpr std::array<HammerConstant, kHammerConstantCount> kHammerConstants{{
    {"crank_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.crank; }, usual::length, -1.0,
     HammerConstant::Enters::kMotion},
    {"rod_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.rod; }, usual::exact, 1.0,
     HammerConstant::Enters::kFollows},
    {"rocker_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.rocker; }, usual::length, 1.0,
     HammerConstant::Enters::kMotion},
    {"pivot_distance_m", "m", [](HammerParameters& p) -> double& { return p.lengths.pivot_distance; }, usual::length,
     1.0, HammerConstant::Enters::kMotion},
    {"rocker_com_distance_m", "m", [](HammerParameters& p) -> double& { return p.rocker_com_distance; },
     [](const HammerParameters&) { return usual::kCentre; }, -1.0, HammerConstant::Enters::kLoads},
    {"rocker_com_angle_deg", "deg", [](HammerParameters& p) -> double& { return p.rocker_com_angle; },
     [](const HammerParameters& p) { return usual::kCentre / p.rocker_com_distance; }, 1.0,
     HammerConstant::Enters::kLoads},
    {"rocker_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.rocker_mass; },
     [](const HammerParameters& p) { return usual::kWeighed * p.rocker_mass; }, -1.0, HammerConstant::Enters::kLoads},
    {"rocker_inertia_about_pivot_kg_m2", "kg m2",
     [](HammerParameters& p) -> double& { return p.rocker_inertia_about_pivot; },
     [](const HammerParameters& p) { return usual::kWeighed * p.rocker_inertia_about_pivot; }, 1.0,
     HammerConstant::Enters::kLoads},
    {"striking_distance_m", "m", [](HammerParameters& p) -> double& { return p.striking_distance; }, usual::length, 1.0,
     HammerConstant::Enters::kBlow},
    {"striking_offset_m", "m", [](HammerParameters& p) -> double& { return p.striking_offset; }, usual::exact, 1.0,
     HammerConstant::Enters::kBlow, true},
    {"striking_friction", "", [](HammerParameters& p) -> double& { return p.striking_friction; }, usual::exact, 1.0,
     HammerConstant::Enters::kBlow, true},
    {"crank_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.crank_mass; },
     [](const HammerParameters& p) { return usual::kGuessed * p.crank_mass; }, 1.0, HammerConstant::Enters::kLoads},
    {"crank_com_along_m", "m", [](HammerParameters& p) -> double& { return p.crank_com_along; },
     [](const HammerParameters& p) { return usual::kGuessed * std::abs(p.crank_com_along); }, 1.0,
     HammerConstant::Enters::kLoads},
    {"crank_com_across_m", "m", [](HammerParameters& p) -> double& { return p.crank_com_across; },
     [](const HammerParameters& p) { return usual::kGuessed * std::abs(p.crank_com_across); }, 1.0,
     HammerConstant::Enters::kLoads},
    {"crank_inertia_about_com_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.crank_inertia_about_com; },
     [](const HammerParameters& p) { return usual::kGuessed * p.crank_inertia_about_com; }, 1.0,
     HammerConstant::Enters::kLoads},
    {"rod_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.rod_mass; },
     [](const HammerParameters& p) { return usual::kGuessed * p.rod_mass; }, 1.0, HammerConstant::Enters::kLoads},
    {"rod_com_along_m", "m", [](HammerParameters& p) -> double& { return p.rod_com_along; },
     [](const HammerParameters& p) { return usual::kGuessed * std::abs(p.rod_com_along); }, 1.0,
     HammerConstant::Enters::kLoads},
    {"rod_com_across_m", "m", [](HammerParameters& p) -> double& { return p.rod_com_across; },
     [](const HammerParameters& p) { return usual::kGuessed * std::abs(p.rod_com_across); }, 1.0,
     HammerConstant::Enters::kLoads},
    {"rod_inertia_about_com_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.rod_inertia_about_com; },
     [](const HammerParameters& p) { return usual::kGuessed * p.rod_inertia_about_com; }, 1.0,
     HammerConstant::Enters::kLoads},
    {"drive_inertia_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.drive_inertia; }, usual::exact, 1.0,
     HammerConstant::Enters::kLearned},
    {"drive_reaction_ratio", "", [](HammerParameters& p) -> double& { return p.drive_reaction_ratio; }, usual::exact,
     1.0, HammerConstant::Enters::kLoads, true},
}};

/// Place of a key in kHammerConstants, if it is there.
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
