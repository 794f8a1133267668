#include "hammer_loads/settings/hammer_parameters.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

struct HammerKey {
  const char* key;
  const char* unit;
  double& (*field)(HammerParameters&);
  NumberRule rule;
};

// From a model on a desk to hammers larger than any machine carries. Signs are the mechanism's to judge.
constexpr NumberRule kLength = NumberRule::within(1e-3, 10.0), kOffset = NumberRule::within(-10.0, 10.0);
constexpr NumberRule kMass = NumberRule::within(1e-3, 1e5), kMassOrNone = NumberRule::zeroOrWithin(1e-6, 1e5);
constexpr NumberRule kInertia = NumberRule::within(1e-9, 1e6), kInertiaOrNone = NumberRule::zeroOrWithin(1e-12, 1e6);
// Matter lies some radii of gyration from the pivot; a lever of less would make any blow's impulse endless.
constexpr double kLeastLever = 0.1, kMostLever = 10.0;

constexpr HammerKey kHammerKeys[] = {
    {"crank_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.crank; }, kLength},
    {"rod_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.rod; }, kLength},
    {"rocker_length_m", "m", [](HammerParameters& p) -> double& { return p.lengths.rocker; }, kLength},
    {"pivot_distance_m", "m", [](HammerParameters& p) -> double& { return p.lengths.pivot_distance; }, kLength},
    {"rocker_com_distance_m", "m", [](HammerParameters& p) -> double& { return p.rocker_com_distance; }, kLength},
    {"rocker_com_angle_deg", "deg", [](HammerParameters& p) -> double& { return p.rocker_com_angle; },
     NumberRule::within(-360.0, 360.0)},
    {"rocker_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.rocker_mass; }, kMass},
    {"rocker_inertia_about_pivot_kg_m2", "kg m2",
     [](HammerParameters& p) -> double& { return p.rocker_inertia_about_pivot; }, kInertia},
    {"striking_distance_m", "m", [](HammerParameters& p) -> double& { return p.striking_distance; }, kLength},
    {"striking_friction", "", [](HammerParameters& p) -> double& { return p.striking_friction; },
     NumberRule::within(0.0, 2.0)},
    {"crank_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.crank_mass; }, kMassOrNone},
    {"crank_com_along_m", "m", [](HammerParameters& p) -> double& { return p.crank_com_along; }, kOffset},
    {"crank_com_across_m", "m", [](HammerParameters& p) -> double& { return p.crank_com_across; }, kOffset},
    {"crank_inertia_about_com_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.crank_inertia_about_com; },
     kInertiaOrNone},
    {"rod_mass_kg", "kg", [](HammerParameters& p) -> double& { return p.rod_mass; }, kMassOrNone},
    {"rod_com_along_m", "m", [](HammerParameters& p) -> double& { return p.rod_com_along; }, kOffset},
    {"rod_com_across_m", "m", [](HammerParameters& p) -> double& { return p.rod_com_across; }, kOffset},
    {"rod_inertia_about_com_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.rod_inertia_about_com; },
     kInertiaOrNone},
    {"drive_inertia_kg_m2", "kg m2", [](HammerParameters& p) -> double& { return p.drive_inertia; }, kInertia},
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
  for (const HammerKey& key : kHammerKeys) {
    const double in_file = key.field(parameters) / (std::string(key.unit) == "deg" ? kDegree : 1.0);
    if (std::isfinite(in_file)) reader.demand(key.key, key.unit, in_file, key.rule);
  }
  const double gyration = std::sqrt(parameters.rocker_inertia_about_pivot / parameters.rocker_mass);
  if (mechanism.value)
    reader.demand("striking_distance_m", "m", parameters.striking_distance,
                  NumberRule::within(kLeastLever * gyration, kMostLever * gyration));
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
