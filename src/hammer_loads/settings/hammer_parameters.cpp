#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

// Bounds from a model on a desk to hammers larger than any machine carries. The mechanism checks the signs.
constexpr NumberRule kLength = NumberRule::within(1e-3, 10.0), kOffset = NumberRule::within(-10.0, 10.0);
constexpr NumberRule kMass = NumberRule::within(1e-3, 1e5), kMassOrNone = NumberRule::zeroOrWithin(1e-6, 1e5);
constexpr NumberRule kInertia = NumberRule::within(1e-9, 1e6), kInertiaOrNone = NumberRule::zeroOrWithin(1e-12, 1e6);
constexpr NumberRule kStiffness = NumberRule::zeroOrWithin(1e6, 1e12), kDampingRatio = NumberRule::within(0.0, 100.0);
constexpr NumberRule kPlay = NumberRule::within(0.0, 0.01), kFriction = NumberRule::within(0.0, 2.0);
// Bounds of the lever in radii of gyration. A much shorter one would make the impulse of any blow infinite.
constexpr double kLeastLever = 0.1, kMostLever = 10.0;

/// Rules in the order of kHammerConstants.
constexpr NumberRule kRules[kHammerConstantCount] = {kLength,        kLength,   kLength,
                                                     kLength,        kLength,   NumberRule::within(-360.0, 360.0),
                                                     kMass,          kInertia,  kLength,
                                                     kOffset,        kFriction, kMassOrNone,
                                                     kOffset,        kOffset,   kInertiaOrNone,
                                                     kMassOrNone,    kOffset,   kOffset,
                                                     kInertiaOrNone, kInertia,  NumberRule::within(-10.0, 10.0)};
constexpr const char* kRatio = "drive_reaction_ratio";

void name(const std::string& key, double deviation, std::string& usual) {
  usual += format("%s%s %.3g", usual.empty() ? "" : ", ", key.c_str(), deviation);
}

/// Reads the standard deviations of the file. The others get their default, which `usual` names.
void readDeviations(ParameterReader& reader, HammerParameters& parameters, std::string& usual) {
  parameters.deviations = usualDeviations(parameters);
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    const std::string key = deviationKey(constant);
    double& deviation = parameters.deviations[i];
    if (reader.given(key)) {
      deviation = reader.number(key, constant.unit, NumberRule::within(0.0, 1e6)) / inFile(constant, 1.0);
    } else if (deviation > 0.0) {
      name(key, inFile(constant, deviation), usual);
    }
  }
}

/// Reports standard deviations that are impossible for a hammer with the other values.
void checkDeviations(ParameterReader& reader, const HammerParameters& parameters) {
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    const std::string key = deviationKey(constant);
    if (reader.given(key) && !isPossible(parameters, i))
      reader.addProblem(format("%s: %.9g %s, no hammer of the other values is so far off", key.c_str(),
                               inFile(constant, parameters.deviations[i]), constant.unit));
  }
}

struct RodKey {
  const char *key, *deviation, *unit;
  double RodSpring::*field;
  NumberRule rule;
};
constexpr RodKey kRodKeys[] = {
    {"rod_stiffness_N_m", "rod_stiffness_std_N_m", "N/m", &RodSpring::stiffness, kStiffness},
    {"rod_damping_ratio", "rod_damping_ratio_std", "", &RodSpring::damping_ratio, kDampingRatio},
    {"pin_play_m", "pin_play_std_m", "m", &RodSpring::play, kPlay},
    {"pin_friction_radius_m", "pin_friction_radius_std_m", "m", &RodSpring::friction_radius, kPlay}};

/// All keys are optional. If the other constants of a hammer are all exact, the rod is exact as well unless the file
/// states otherwise.
void readRod(ParameterReader& reader, HammerParameters& parameters, std::string& usual) {
  for (const RodKey& k : kRodKeys)
    if (reader.given(k.key)) parameters.rod.*k.field = reader.number(k.key, k.unit, k.rule);
  const HammerDeviations& others = parameters.deviations;
  const bool exact = std::all_of(others.begin(), others.end(), [](double deviation) { return deviation == 0.0; });
  if (!exact || parameters.rod.stiffness > 0.0) parameters.rod_std = usualDeviation(parameters.rod);
  for (const RodKey& k : kRodKeys) {
    double& deviation = parameters.rod_std.*k.field;
    if (reader.given(k.deviation))
      deviation = reader.number(k.deviation, k.unit, NumberRule::within(0.0, 1e12));
    else if (deviation > 0.0)
      name(k.deviation, deviation, usual);
  }
}

/// Reads the optional mass of the hull, on which the motion of an unmeasured hull depends.
void readHullMass(ParameterReader& reader, HammerParameters& parameters) {
  constexpr const char *kHullMass = "hull_mass_kg", *kDeviation = "hull_mass_std_kg";
  constexpr double kUsual = 0.3;  // default relative standard deviation of a mass
  if (reader.given(kHullMass)) parameters.hull_mass = reader.number(kHullMass, "kg", NumberRule::within(1.0, 1e5));
  parameters.hull_mass_std = kUsual * parameters.hull_mass;
  if (!reader.given(kDeviation)) return;
  parameters.hull_mass_std = reader.number(kDeviation, "kg", NumberRule::within(0.0, 1e5));
  if (!(parameters.hull_mass > 0.0)) reader.addProblem(std::string(kDeviation) + ": must stand beside " + kHullMass);
}

}  // namespace

std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes) {
  const std::size_t problems_before = reader.problems().size();
  HammerParameters parameters;
  // The mechanism checks the signs and the relations between keys.
  for (const HammerConstant& constant : kHammerConstants) {
    if (constant.optional && !reader.given(constant.key)) continue;
    constant.field(parameters) = reader.number(constant.key, constant.unit, NumberRule::any()) / inFile(constant, 1.0);
  }

  std::string usual;
  readDeviations(reader, parameters, usual);  // in any case, so that these keys are known
  readRod(reader, parameters, usual);
  readHullMass(reader, parameters);
  const Checked<Mechanism> mechanism = Mechanism::make(parameters);
  for (const std::string& problem : mechanism.problems) reader.addProblem(problem);
  for (std::size_t i = 0; i < kHammerConstantCount; ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    const double value = inFile(constant, constant.field(parameters));
    if (std::isfinite(value)) reader.demand(constant.key, constant.unit, value, kRules[i]);
  }
  const double gyration = std::sqrt(parameters.rocker_inertia_about_pivot / parameters.rocker_mass);
  if (mechanism.value)
    reader.demand("striking_distance_m", "m", parameters.striking_distance,
                  NumberRule::within(kLeastLever * gyration, kMostLever * gyration));
  if (reader.problems().size() == problems_before) checkDeviations(reader, parameters);
  notes.insert(notes.end(), mechanism.notes.begin(), mechanism.notes.end());
  if (!usual.empty()) notes.push_back("standard deviations not given, the usual ones count: " + usual);
  if (!reader.given(kRatio))
    notes.push_back(std::string(kRatio) +
                    ": not given, counts as 1: the hull feels the drive's reaction as of a flywheel on the crank's "
                    "shaft");
  if (reader.problems().size() != problems_before) return std::nullopt;
  return mechanism.value;
}

std::vector<std::string> hammerKeys() {
  std::vector<std::string> keys;
  for (const HammerConstant& constant : kHammerConstants)
    if (!constant.optional) keys.emplace_back(constant.key);
  return keys;
}

std::vector<std::pair<std::string, double>> deviationsInForce(const HammerParameters& parameters) {
  std::vector<std::pair<std::string, double>> deviations;
  for (std::size_t i = 0; i < kHammerConstantCount; ++i)
    deviations.emplace_back(deviationKey(kHammerConstants[i]), inFile(kHammerConstants[i], parameters.deviations[i]));
  for (const RodKey& k : kRodKeys) deviations.emplace_back(k.deviation, parameters.rod_std.*k.field);
  return deviations;
}

/// Returns true if a key of the mechanism is given. The drive's inertia does not count, as a first guess that a
/// calibration replaces, nor does drive_reaction_ratio, which is not a property of the mechanism.
bool hasHammerKey(const ParameterMap& parameters) {
  return std::any_of(kHammerConstants.begin(), kHammerConstants.end(), [&](const HammerConstant& constant) {
    const bool of_drive = constant.enters == HammerConstant::Enters::kLearned || std::string(constant.key) == kRatio;
    return !of_drive && parameters.count(constant.key) != 0;
  });
}

}  // namespace hammer_loads
