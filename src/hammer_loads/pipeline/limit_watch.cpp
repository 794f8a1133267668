#include "hammer_loads/pipeline/limit_watch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hammer_loads {

void LastHour::add(double time, double amount) noexcept {
  const auto minute = static_cast<std::uint64_t>(std::max(0.0, time) / 60.0);
  if (minute > minute_ + minutes_.size()) minute_ = minute - minutes_.size();
  while (minute_ < minute) minutes_[++minute_ % minutes_.size()] = 0.0;
  minutes_[minute_ % minutes_.size()] += amount;
}

double LastHour::sum() const noexcept { return std::accumulate(minutes_.begin(), minutes_.end(), 0.0); }

LimitWatch::LimitWatch(std::vector<Limit> limits, std::vector<life::CountedChannel> channels,
                       const MisuseCounts& misuse)
    : limits_(std::move(limits)),
      states_(limits_.size()),
      channel_(limits_.size()),
      damage_(limits_.size()),
      channels_(std::move(channels)),
      before_(misuse),
      misuse_(misuse) {
  for (std::size_t i = 0; i < limits_.size(); ++i)
    while (limits_[i].quantity == LimitedQuantity::kDamage && channels_.at(channel_[i]).name != limits_[i].channel)
      ++channel_[i];
}

/// Adds the damage of the cycles by which a count exceeds the previous one. A shorter count is a new one.
void LimitWatch::followDamage(const life::LifePiece& counted) {
  const std::uint64_t before = std::exchange(counted_until_, counted.duration);
  if (counted.duration == before) return;
  if (counted.duration < before)
    for (Damage& damage : damage_) damage.total = {};
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (limits_[i].quantity != LimitedQuantity::kDamage) continue;
    const life::CountedChannel& channel = channels_[channel_[i]];
    const life::CycleCount& count = counted.counts[channel_[i]];
    const life::Figure total =
        life::damage(life::rangesAndMeans(count), *channel.curve, channel.mean_stress, life::rangeDeviation(count));
    damage_[i].hour.add(misuse_.work_time - before_.work_time, total.value - damage_[i].total.value);
    damage_[i].total = total;
  }
}

LimitWatch::Value LimitWatch::valueOf(std::size_t limit, const TurnEnd& end) const {
  switch (limits_[limit].quantity) {
    case LimitedQuantity::kPeakForce:
      if (!end.pulse) return {};
      return {end.pulse->amplitude, end.pulse_errors.amplitude.deviation()};
    case LimitedQuantity::kBlowEnergy:
      return {end.blow.energy, end.blow.energy_std};
    case LimitedQuantity::kHoldDownForce:
      return {end.mean_hold_down_force, std::abs(end.mean_hold_down_force / end.blow.tool_impulse_z) *
                                            end.blow_errors.tool_impulse_z.deviation()};
    case LimitedQuantity::kBlankFiring:
      return {blank_.sum(), kNaN};
    case LimitedQuantity::kDamage:
      break;
  }
  if (counted_until_ == 0) return {};
  const Damage& damage = damage_[limit];
  const double value = damage.hour.sum();
  return {value, damage.total.value > 0.0 ? value * damage.total.deviation / damage.total.value : 0.0};
}

bool LimitWatch::judge(const TurnEnd& end, const MisuseCounts& misuse, const std::optional<life::LifePiece>& counted) {
  blank_.add(misuse.work_time - before_.work_time,
             static_cast<double>(misuse.blank_firings - std::exchange(misuse_, misuse).blank_firings));
  if (counted) followDamage(*counted);
  bool publish = !std::exchange(begun_, true);
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const Limit& limit = limits_[i];
    LimitState& state = states_[i];
    publish = publish || state.level != AlarmLevel::kOk;
    const Value now = valueOf(i, end);
    if (std::isnan(now.value)) continue;
    const bool error = limit.exceeds(now.value, limit.error), warn = limit.exceeds(now.value, limit.warn);
    const AlarmLevel level = error ? AlarmLevel::kError : warn ? AlarmLevel::kWarn : AlarmLevel::kOk;
    if (level != state.level || state.since == 0) state.since = end.stamp;
    state.level = level, state.value = now.value, state.std = now.std;
    state.limit = error ? limit.error : warn ? limit.warn : kNaN;
    publish = publish || level != AlarmLevel::kOk;
  }
  return publish;
}

}  // namespace hammer_loads
