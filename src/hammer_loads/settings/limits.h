/// Limits of a machine's loads and work, from its limits file.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

enum class LimitedQuantity { kPeakForce, kBlowEnergy, kHoldDownForce, kBlankFiring, kDamage };

struct Limit {
  std::string name, unit;
  LimitedQuantity quantity{};
  bool is_least{};                 ///< a least value; otherwise values above the limits exceed them
  double warn{kNaN}, error{kNaN};  ///< in the unit; NaN: none
  std::string channel{};           ///< channel of kDamage: stress/NAME

  bool exceeds(double value, double limit) const noexcept { return is_least ? value < limit : value > limit; }
};

/// Reads the given limits, each by a key `limit_NAME_warn_UNIT` or `limit_NAME_error_UNIT` (config/limits.yaml). Usable
/// only if the reader got no problem.
std::vector<Limit> readLimits(ParameterReader& reader, const life::LifeSettings& life);

/// Adds the parameters of the file that the key limits_file names, under those given already, and removes the key:
/// what is in force is then complete without the file.
void addLimitsFile(ParameterMap& given, std::vector<std::string>& problems);

}  // namespace hammer_loads
