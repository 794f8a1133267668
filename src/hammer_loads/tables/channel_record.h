/// One load channel of a run, in the tables.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/tables/run_record.h"

namespace hammer_loads {

/// Figures of counting and S-N curve; NaN where there is none of them.
struct ChannelCount {
  double least{}, greatest{};  ///< the grid's ends, in the channel's unit
  std::uint64_t classes{};
  std::uint64_t samples{}, skipped{}, below{}, above{}, gaps{};
  double minimum{}, maximum{}, mean_std{}, range_own_std{}, range_systematic_std{};
  double sn_knee_range{RunRecord::kUnknown};  ///< [MPa]
  double sn_knee_cycles{RunRecord::kUnknown}, sn_slope{RunRecord::kUnknown}, sn_slope_below{RunRecord::kUnknown};
  double mean_stress_sensitivity{RunRecord::kUnknown};
  std::vector<std::uint32_t> steps, low;  ///< steps of closed cycles, and their lower class
  std::vector<std::uint64_t> count;
  std::vector<std::uint32_t> residue;  ///< classes of turning points in time order
};

struct ChannelRecord {
  std::string name;  ///< topic/field or topic/name/field, stress/NAME of a hot spot
  std::optional<ChannelCount> count;
};

/// Extremes and mean of one channel in one turn.
struct TurnLoad {
  std::uint64_t turn{};
  std::int64_t channel{};
  double minimum{}, maximum{}, mean{};
  double minimum_std{}, maximum_std{}, minimum_systematic_std{}, maximum_systematic_std{};
};

/// Share of one source in the variance of a figure.
struct BudgetRow {
  std::string quantity;  ///< message/field, or equivalent_range_3/CHANNEL
  double value{}, deviation{};
  std::string source;
  double share{};  ///< part of the variance; the parts of a quantity sum to 1
};

}  // namespace hammer_loads
