#include "hammer_loads/settings/hammer_parameters.h"

#include <algorithm>

#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

struct HammerKey {
  const char* key;
  const char* unit;
  double& (*field)(HammerParameters&);
};

constexpr HammerKey kHammerKeys[] = {
    {"crank_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.crank; }},
    {"rod_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.rod; }},
    {"rocker_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.rocker; }},
    {"pivot_distance_m", "m", [](HammerParameters& p) -> double& { return p.lengths.pivot_distance; }},
    {"rocker_com_distance_m", "m", [](HammerParameters& p) -> double& { return p.rocker_com_distance; }},
    {"rocker_com_angle_deg", "deg", [](HammerParameters& p) -> double& { return p.rocker_com_angle; }},
    {"rocker_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.rocker_mass; }},
    {"rocker_inertia_about_pivot_kg_m2", "kg m2",
     [](HammerParameters& p) -> double& { return p.rocker_inertia_about_pivot; }},
    {"striking_distance_m", "m", [](HammerParameters& p) -> double& { return p.striking_distance; }},
    {"striking_friction", "", [](HammerParameters& p) -> double& { return p.striking_friction; }},
    {"crank_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.crank_mass; }},
    {"crank_com_along_m", "m", [](HammerParameters& p) -> double& { return p.crank_com_along; }},
    {"crank_com_across_m", "m", [](HammerParameters& p) -> double& { return p.crank_com_across; }},
    {"crank_inertia_about_com_kg_m2", "kg m2",
     [](HammerParameters& p) -> double& { return p.crank_inertia_about_com; }},
    {"rod_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.rod_mass; }},
    {"rod_com_along_m", "m", [](HammerParameters& p) -> double& { return p.rod_com_along; }},
    {"rod_com_across_m", "m", [](HammerParameters& p) -> double& { return p.rod_com_across; }},
    {"rod_inertia_about_com_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.rod_inertia_about_com; }},
    {"drive_inertia_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.drive_inertia; }},
};

constexpr const char* kRatioKey = "drive_reaction_ratio";

}  // namespace

std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes) {
  const std::size_t problems_before = reader.problems().size();
  HammerParameters parameters;
  // Signs and what keys demand of each other are the mechanism's to judge.
  for (const HammerKey& key : kHammerKeys) key.field(parameters) = reader.number(key.key, key.unit, NumberRule::any());
  parameters.rocker_com_angle *= kDegree;

  if (reader.given(kRatioKey))
    parameters.drive_reaction_ratio = reader.number(kRatioKey, "", NumberRule::within(-10.0, 10.0));

  Checked<Mechanism> mechanism = Mechanism::make(parameters);
  for (const std::string& problem : mechanism.problems) reader.addProblem(problem);
  notes.insert(notes.end(), mechanism.notes.begin(), mechanism.notes.end());
  if (!reader.given(kRatioKey))
    notes.push_back(
        std::string(kRatioKey) +
        ": not given, counts as 1: the hull feels the drive's reaction as of a flywheel on the crank's shaft");
  if (reader.problems().size() != problems_before) return std::nullopt;
  return mechanism.value;
}

std::vector<std::string> hammerKeys() {
  std::vector<std::string> keys;
  for (const HammerKey& key : kHammerKeys) keys.emplace_back(key.key);
  return keys;
}

/// The drive's inertia is a first guess, which a calibration replaces in any hammer; how it turns is no part of the
/// mechanism.
bool hasHammerKey(const ParameterMap& parameters) {
  return std::any_of(std::begin(kHammerKeys), std::end(kHammerKeys), [&](const HammerKey& key) {
    return std::string(key.key) != "drive_inertia_kg_m2" && parameters.count(key.key) != 0;
  });
}

}  // namespace hammer_loads
