/// Check of a machine's limits, once per revolution.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/pipeline/misuse.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/settings/limits.h"

namespace hammer_loads {

/// Values as in diagnostic_msgs/DiagnosticStatus.
enum class AlarmLevel : std::uint8_t { kOk, kWarn, kError };

/// One limit at the last revolution at which its value was known. It is exceeded only if the value itself is beyond it,
/// whatever its standard deviation.
struct LimitState {
  AlarmLevel level{};
  double value{kNaN}, std{kNaN};  ///< in the limit's unit; NaN: not known yet; the std of a count is never known
  double limit{kNaN};             ///< limit that is exceeded
  StampNs since{};                ///< stamp of the first revolution at the present level [ns]
};

/// Sum over the last hour of work, in whole minutes, or over all of the work if that is shorter. It is not
/// extrapolated.
class LastHour {
 public:
  /// Adds an amount. time: working time, not less than at the last call [s].
  void add(double time, double amount) noexcept;
  double sum() const noexcept;

 private:
  std::array<double, 60> minutes_{};
  std::uint64_t minute_{};
};

class LimitWatch {
 public:
  /// channels: of the counts that judge() gets. misuse: counts before the first revolution.
  LimitWatch(std::vector<Limit> limits, std::vector<life::CountedChannel> channels, const MisuseCounts& misuse);

  /// Ends a revolution. counted: the load cycles so far, as of the last period. Returns true if the alarms are to be
  /// published: at the first revolution and at each where an alarm begins, lasts or ends.
  bool judge(const TurnEnd& end, const MisuseCounts& misuse, const std::optional<life::LifePiece>& counted);

  const std::vector<Limit>& limits() const { return limits_; }
  const std::vector<LimitState>& states() const { return states_; }  ///< in the order of the limits

 private:
  struct Value {
    double value{kNaN}, std{kNaN};
  };
  struct Damage {
    LastHour hour;
    life::Figure total;
  };

  void followDamage(const life::LifePiece& counted);
  Value valueOf(std::size_t limit, const TurnEnd& end) const;

  std::vector<Limit> limits_;
  std::vector<LimitState> states_;
  std::vector<std::size_t> channel_;  ///< index in channels_ for each limit of damage
  std::vector<Damage> damage_;        ///< damage for each limit
  std::vector<life::CountedChannel> channels_;
  MisuseCounts before_, misuse_;
  LastHour blank_;
  std::uint64_t counted_until_{};  ///< duration of the count from which damage_ follows [ns]
  bool begun_{};
};

}  // namespace hammer_loads
