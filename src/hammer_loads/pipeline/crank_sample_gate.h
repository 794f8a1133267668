/// Checks of crank samples that need no model.
#pragma once

#include <optional>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/pipeline/refusal.h"
#include "hammer_loads/pipeline/stamp_order.h"

namespace hammer_loads {

/// A sample's own values and its place in time.
class CrankSampleGate {
 public:
  struct Limits {
    double max_speed{};     ///< largest speed of any crank [rad/s]
    double stale_after{};   ///< age of the last sample from which on a new one restarts [s]
    double frozen_turn{};   ///< a crank that turned further does not give the same angle again [rad]
    double frozen_speed{};  ///< speed above which equal readings are frozen however soon they follow [rad/s]
  };
  explicit CrankSampleGate(const Limits& limits) : limits_(limits), stamps_(limits.stale_after) {}

  enum class Order { kFirst, kNext };
  struct Verdict {
    std::optional<Refusal> refusal;
    Order order{Order::kFirst};
    double step{};         ///< since the last accepted sample [s]
    bool speed_is_dead{};  ///< only zeros while the angle moves, as sent by drivers that do not measure the speed
  };

  /// Reason for which a sample's own values cannot be accepted, whatever its stamp.
  std::optional<Refusal> refusalOf(const CrankSample& sample) const noexcept;
  Verdict judge(StampNs stamp, const CrankSample& sample) noexcept;
  void accept(StampNs stamp, const CrankSample& sample) noexcept {
    stamps_.accept(stamp);
    accepted_ = sample;
  }
  void setFrozenTurn(double turn) noexcept { limits_.frozen_turn = turn; }  ///< [rad], as Limits
  const std::optional<StampNs>& last() const noexcept { return stamps_.last(); }
  bool angleIsFrozen() const noexcept { return frozen_; }  ///< the last sample was refused for that

 private:
  bool isFrozen(double step, const CrankSample& sample) noexcept;
  bool isSpeedDead(const CrankSample& sample) const noexcept;

  Limits limits_;
  StampOrder stamps_;
  CrankSample accepted_;  ///< last
  bool frozen_{};         ///< true while the reading has not changed though the crank turned
};

}  // namespace hammer_loads
