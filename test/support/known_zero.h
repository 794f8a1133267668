/// Zero of the crank's sensor as `calibrate` finds it, for tests without the first turns' search.
#pragma once

namespace hammer_loads {

constexpr double kKnownZeroStd = 0.003;  ///< standard deviation of the zero [rad]
constexpr const char* kKnownZeroYaml = "crank_zero_std_rad: 0.003\n";

}  // namespace hammer_loads
