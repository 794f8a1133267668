#include "hammer_loads/settings/limits.h"

#include <cmath>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

constexpr char kFileKey[] = "limits_file";

/// Reads a bound. Returns NaN if the key is not given.
double readBound(ParameterReader& reader, const std::string& key, const std::string& unit) {
  return reader.given(key) ? reader.number(key, unit, NumberRule::notNegative()) : kNaN;
}

void readLimit(ParameterReader& reader, Limit limit, std::vector<Limit>& limits) {
  const bool per_hour = limit.unit == "1/h";  // the name states the unit
  const std::string ending = per_hour ? "" : "_" + limit.unit;
  const std::string warn = "limit_" + limit.name + "_warn" + ending, error = "limit_" + limit.name + "_error" + ending;
  limit.warn = readBound(reader, warn, limit.unit);
  limit.error = readBound(reader, error, limit.unit);
  if (limit.exceeds(limit.warn, limit.error))
    reader.addProblem(error + ": " + numberText(limit.error) + " " + limit.unit + ", must be " +
                      (limit.is_least ? "<= " : ">= ") + warn + " (" + numberText(limit.warn) + ")");
  if (!std::isnan(limit.warn) || !std::isnan(limit.error)) limits.push_back(std::move(limit));
}

}  // namespace

std::vector<Limit> readLimits(ParameterReader& reader, const life::LifeSettings& life) {
  std::vector<Limit> limits;
  for (const Limit& limit : {Limit{"peak_force", "N", LimitedQuantity::kPeakForce},
                             Limit{"blow_energy_least", "J", LimitedQuantity::kBlowEnergy, true},
                             Limit{"blow_energy_greatest", "J", LimitedQuantity::kBlowEnergy},
                             Limit{"hold_down_force", "N", LimitedQuantity::kHoldDownForce},
                             Limit{"blank_firing_per_hour", "1/h", LimitedQuantity::kBlankFiring}})
    readLimit(reader, limit, limits);
  for (const life::CountedChannel& channel : life.channels)
    if (channel.curve)
      readLimit(reader,
                {channel.key + "_damage_per_hour", "1/h", LimitedQuantity::kDamage, false, kNaN, kNaN,
                 life::countedName(channel.name, life.bandwidth)},
                limits);
  return limits;
}

void addLimitsFile(ParameterMap& given, std::vector<std::string>& problems) {
  const auto found = given.find(kFileKey);
  if (found == given.end()) return;
  const std::optional<std::string> file = asText(found->second.value);
  if (!file || file->empty())
    problems.push_back(std::string(kFileKey) + ": " + describe(found->second.value) + ", must be a file, or none");
  given.erase(found);
  ParameterMap limits;
  if (!file || file->empty() || *file == "none" || !addFiles({*file}, limits, problems)) return;
  merge(given, limits);
  given.swap(limits);
}

}  // namespace hammer_loads
