#include "hammer_loads/crank/stamp_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {
namespace {

constexpr double kMany = 5.0;  // irregular stamps of a thousand: not a single late message
// Guard: StampSequence.IsRefittedWhereMoreThanFiveOfAThousandChangePlaces of kMany
constexpr double kSingle = 1.5;  // likewise
// Guard: StampSequence.OneStampThatRepeatsIsNoBurstYet of kSingle
constexpr std::int64_t kLeastStep = 1000;  // [ns] between instants where stamps repeat and no interval is known
// Numerical: kLeastStep

}  // namespace

StampSequence::StampSequence(CrankStamps mode, double stale_after) noexcept
    : mode_(mode), stale_(static_cast<std::int64_t>(std::llround(stale_after * 1e9))) {}

StampSequence::Place StampSequence::begin(std::int64_t header) noexcept {
  header_ = newest_ = placed_ = header;
  rewound_.reset();
  irregularity_ = 0.0;
  uncounted_ = false;
  steady_ = mode_ == CrankStamps::kSteady;
  fit_.begin(header);
  return {Kind::kRestart, header, false};
}

StampSequence::Place StampSequence::place(std::int64_t header, Repeats repeats) noexcept {
  if (!header_) return begin(header);
  const bool may_be_burst = repeats == Repeats::kWithinCount || (repeats == Repeats::kAtRest && !doubled_);
  if (header == *header_ && repeats != Repeats::kNo && !(may_be_burst && irregularity_ > kMany)) {
    uncounted_ = uncounted_ || repeats != Repeats::kAtWork;
    if (repeats == Repeats::kAtWork && !std::exchange(doubled_, true)) fit_.begin(header);  // it may have counted some
    return {Kind::kDuplicate, header, false};
  }
  const std::int64_t back = newest_ - header;
  const bool too_far = mode_ == CrankStamps::kHeader ? back > 0 : back > stale_;
  if (too_far) {  // a single one may just be late
    const bool again = rewound_ && header > *rewound_;
    rewound_ = header;
    return again ? begin(header) : Place{Kind::kOutOfOrder, header, false};
  }
  if (mode_ == CrankStamps::kHeader && back == 0) return {Kind::kDuplicate, header, false};
  rewound_.reset();
  if (-back > stale_) return begin(header);
  return next(header);
}

std::int64_t StampSequence::skip(double time) noexcept {
  fit_.skip(1e9 * time / fit_.interval());
  return placed_ += static_cast<std::int64_t>(std::llround(1e9 * time));
}

StampSequence::Place StampSequence::next(std::int64_t header) noexcept {
  rounding_.add(header - *header_);
  const bool repeats = header == *header_;
  if (uncounted_ && repeats) {  // they were not: stamps come in bursts
    fit_.begin(header);
    uncounted_ = false;
  }
  const std::int64_t fitted = fit_.add(header);
  const bool irregular = header <= newest_;
  irregular_ += irregular;
  irregularity_ += (irregular ? 1.0 : 0.0) - irregularity_ / look_back::kManyReadings;
  header_ = header;
  newest_ = std::max(newest_, header);
  if (mode_ == CrankStamps::kAuto && irregularity_ > kMany && fit_.explains()) steady_ = true;
  const bool knows = fit_.isKnown() && (steady_ || !fit_.inBursts());
  const bool single = irregularity_ < kSingle && fit_.runs() > 0;  // one alone is no burst
  if (repeats && !knows && !single) return {Kind::kDuplicate, header, false};
  std::int64_t instant = header;
  if (steady_) {
    instant = fitted;
  } else if (header <= placed_) {
    const auto half = static_cast<std::int64_t>(0.5 * fit_.interval());
    instant = std::min(fitted, placed_ + std::max(half, kLeastStep));
  }
  placed_ = instant > placed_ ? instant : placed_ + kLeastStep;
  return {Kind::kPlaced, placed_, placed_ != header};
}

}  // namespace hammer_loads
