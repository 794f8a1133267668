/// One run as a whole, in the tables.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace hammer_loads {

/// Figures are NaN where they are not known.
struct RunRecord {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  struct Parameter {
    std::string key, value;
    std::optional<std::string> shipped;  ///< value in the shipped files, if it is there
  };
  struct Refusals {
    std::string reason;
    std::uint64_t count{};
  };
  struct Warning {
    std::string key, text;
  };

  std::string input_sha256, parameters_sha256, machine;
  std::string version, revision, parameters_yaml;
  std::optional<std::int64_t> first_stamp, last_stamp;  ///< stamps of published samples [ns]
  double duration{};                                    ///< between published samples, gaps left out [s]
  std::string level;                                    ///< pulse, rocker or linkage
  std::uint64_t samples{}, published{}, restarts{}, turns{}, blows{}, backward_passes{};
  std::uint64_t blank_firings{}, judged_blows{};
  std::optional<std::uint64_t> blows_without_hold_down;  ///< part of the judged ones; none where none was
  double still_time{kUnknown};                           ///< hammering without penetration [s]
  double hull_pitch{kUnknown};                           ///< at the end of the run [rad]
  double consistency{kUnknown};
  double timing_noise{kUnknown};                ///< [s]
  double speed_noise{kUnknown};                 ///< [rad/s]
  double angle_resolution{kUnknown};            ///< [rad]
  double drive_inertia{kUnknown};               ///< [kg m2]
  double drive_inertia_relative_std{kUnknown};  ///< relative [-]
  double equivalent_cycles_per_hour{kUnknown};
  std::vector<Parameter> parameters;
  std::vector<Refusals> refusals;
  std::vector<Warning> warnings;  ///< most important first
};

}  // namespace hammer_loads
