#include "hammer_loads/settings/hammer_parameters.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

// From a model on a desk to hammers larger than any machine carries. Signs are the mechanism's to judge.
constexpr NumberRule kLength = NumberRule::within(1e-3, 10.0), kOffset = NumberRule::within(-10.0, 10.0);
constexpr NumberRule kMass = NumberRule::within(1e-3, 1e5), kMassOrNone = NumberRule::zeroOrWithin(1e-6, 1e5);
constexpr NumberRule kInertia = NumberRule::within(1e-9, 1e6), kInertiaOrNone = NumberRule::zeroOrWithin(1e-12, 1e6);
constexpr NumberRule kStiffness = NumberRule::zeroOrWithin(1e6, 1e12), kDampingRatio = NumberRule::within(0.0, 100.0);
constexpr NumberRule kPlay = NumberRule::within(0.0, 0.01);
// Matter lies some radii of gyration from the pivot; a lever of less would make any blow's impulse endless.
constexpr double kLeastLever = 0.1, kMostLever = 10.0;

/// In the order of kHammerConstants.
constexpr NumberRule kRules[kHammerConstantCount] = {kLength,     kLength,
                                                     kLength,     kLength,
                                                     kLength,     NumberRule::within(-360.0, 360.0),
                                                     kMass,       kInertia,
                                                     kLength,     NumberRule::within(0.0, 2.0),
                                                     kMassOrNone, kOffset,
                                                     kOffset,     kInertiaOrNone,
                                                     kMassOrNone, kOffset,
                                                     kOffset,     kInertiaOrNone,
                                                     kInertia,    NumberRule::within(-10.0, 10.0)};
constexpr std::size_t kRatio = kHammerConstantCount - 1;
static_assert(kHammerConstants[kRatio].key[0] == 'd' && kHammerConstants[kRatio].unit[0] == '\0', "the optional key");

double inFile(const HammerConstant& constant, double value) {
  return std::string(constant.unit) == "deg" ? value / kDegree : value;
}

/// Those that the file gives; of the others what is usual, and one note that names them.
void readDeviations(ParameterReader& reader, HammerParameters& parameters, std::vector<std::string>& notes) {
  parameters.deviations = usualDeviations(parameters);
  std::string usual;
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    const std::string key = deviationKey(constant);
    double& deviation = parameters.deviations[i];
    if (reader.given(key)) {
      deviation = reader.number(key, constant.unit, NumberRule::within(0.0, 1e6)) / inFile(constant, 1.0);
      if (std::isfinite(deviation) && !isPossible(parameters, i))
        reader.addProblem(format("%s: %.9g %s, no hammer of the other values is so far off", key.c_str(),
                                 inFile(constant, deviation), constant.unit));
    } else if (deviation > 0.0) {
      usual += format("%s%s %.3g", usual.empty() ? "" : ", ", key.c_str(), inFile(constant, deviation));
    }
  }
  if (!usual.empty()) notes.push_back("standard deviations not given, the usual ones count: " + usual);
}

/// All optional.
void readRod(ParameterReader& reader, RodSpring& rod) {
  if (reader.given("rod_stiffness_N_m")) rod.stiffness = reader.number("rod_stiffness_N_m", "N/m", kStiffness);
  if (reader.given("rod_damping_ratio")) rod.damping_ratio = reader.number("rod_damping_ratio", "", kDampingRatio);
  if (reader.given("pin_play_m")) rod.play = reader.number("pin_play_m", "m", kPlay);
}

}  // namespace

std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes) {
  const std::size_t problems_before = reader.problems().size();
  HammerParameters parameters;
  // Signs and what keys demand of each other are the mechanism's to judge.
  for (std::size_t i = 0; i < kRatio; ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    constant.field(parameters) = reader.number(constant.key, constant.unit, NumberRule::any()) / inFile(constant, 1.0);
  }
  const char* ratio = kHammerConstants[kRatio].key;
  if (reader.given(ratio)) parameters.drive_reaction_ratio = reader.number(ratio, "", kRules[kRatio]);

  readRod(reader, parameters.rod);

  std::vector<std::string> of_deviations;
  readDeviations(reader, parameters, of_deviations);  // known keys, whatever else is wrong
  const Checked<Mechanism> mechanism = Mechanism::make(parameters);
  for (const std::string& problem : mechanism.problems) reader.addProblem(problem);
  for (std::size_t i = 0; i < kRatio; ++i) {
    const HammerConstant& constant = kHammerConstants[i];
    const double value = inFile(constant, constant.field(parameters));
    if (std::isfinite(value)) reader.demand(constant.key, constant.unit, value, kRules[i]);
  }
  const double gyration = std::sqrt(parameters.rocker_inertia_about_pivot / parameters.rocker_mass);
  if (mechanism.value)
    reader.demand("striking_distance_m", "m", parameters.striking_distance,
                  NumberRule::within(kLeastLever * gyration, kMostLever * gyration));
  notes.insert(notes.end(), mechanism.notes.begin(), mechanism.notes.end());
  notes.insert(notes.end(), of_deviations.begin(), of_deviations.end());
  if (!reader.given(ratio))
    notes.push_back(std::string(ratio) +
                    ": not given, counts as 1: the hull feels the drive's reaction as of a flywheel on the crank's "
                    "shaft");
  if (reader.problems().size() != problems_before) return std::nullopt;
  return mechanism.value;
}

std::vector<std::string> hammerKeys() {
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < kRatio; ++i) keys.emplace_back(kHammerConstants[i].key);
  return keys;
}

/// The drive's inertia is a first guess, which a calibration replaces in any hammer; how it turns is no part of the
/// mechanism.
bool hasHammerKey(const ParameterMap& parameters) {
  return std::any_of(kHammerConstants.begin(), kHammerConstants.begin() + kRatio, [&](const HammerConstant& constant) {
    return constant.enters != HammerConstant::Enters::kLearned && parameters.count(constant.key) != 0;
  });
}

}  // namespace hammer_loads
