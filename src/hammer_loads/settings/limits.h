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
  bool is_least{};                 ///< lower limit, exceeded by values below it; otherwise upper limit
  double warn{kNaN}, error{kNaN};  ///< in the unit; NaN: none
  std::string channel{};           ///< channel of kDamage: stress/NAME

  bool exceeds(double value, double limit) const noexcept { return is_least ? value < limit : value > limit; }
};

/// Reads the given limits, each by a key `limit_NAME_warn_UNIT` or `limit_NAME_error_UNIT` (config/limits.yaml). The
/// result is usable only if the reader has no problem.
std::vector<Limit> readLimits(ParameterReader& reader, const life::LifeSettings& life);

/// Adds the parameters of the file that the key limits_file names, unless they are already given. Removes the key,
/// since the parameters in force are then complete without the file.
void addLimitsFile(ParameterMap& given, std::vector<std::string>& problems);

}  // namespace hammer_loads
