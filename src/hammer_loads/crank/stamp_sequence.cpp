#include "hammer_loads/crank/stamp_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kMemorySamples = 4096.0;   // samples
constexpr double kScatterSamples = 300.0;   // over which scatter is learned, but no fewer than kWarm runs
constexpr int kWarm = 20;                   // runs from which on the line is good enough to judge by
constexpr int kFirst = 4;                   // runs until there is a line
constexpr int kKnown = 6;                   // runs until regular bursts show themselves
constexpr double kBurst = 2.0;              // samples in the mean
constexpr double kRegular = 0.1;            // scatter of bursts over the time between them
constexpr double kClip = gate::kVeryRare;   // root mean squares: a stamp further off counts as that far off
constexpr double kExact = 0.01;             // of the interval: stamps without scatter have this much
constexpr double kGap = gate::kImpossible;  // likewise: samples were lost for certain
constexpr double kEvidence = 16.0;          // logarithm of likelihood that one was lost: by chance in 14 h at 1 kHz
constexpr double kNoLoss = 3.0;             // likewise that none was: 20 to 1
constexpr double kLeastScatter = 0.15;      // of the interval: a run's beginning is not known better
constexpr double kGrown = 2.0;              // scatter about the line over that of white jitter with such steps

// Limits of the sequence.
constexpr double kMany = 5.0;              // irregular stamps of a thousand: not a single late message
constexpr double kSingle = 1.5;            // likewise
constexpr std::int64_t kLeastStep = 1000;  // [ns] between instants where stamps repeat and no interval is known
// Numerical: kLeastStep

}  // namespace

void SteadyClockFit::begin(std::int64_t stamp) noexcept {
  *this = SteadyClockFit{};
  origin_ = stamp_ = stamp;
  run_length_ = 1;
}

bool SteadyClockFit::isKnown() const noexcept { return runs_ >= kKnown; }

bool SteadyClockFit::inBursts() const noexcept { return mean_length_ > kBurst; }

bool SteadyClockFit::explains() const noexcept {
  if (isKnown() && inBursts() && end_square_ < square(kRegular * mean_length_ * interval_)) return true;
  return runs_ >= kWarm && interval_ > 0.0 && end_square_ <= square(kGrown) * 0.5 * step_square_;
}

bool SteadyClockFit::contradictsLoss() const noexcept {
  return interval_ / end_square_ * (0.5 * interval_ - residual_) > kNoLoss;
}

double SteadyClockFit::scatterGain() const noexcept {
  return 1.0 / std::min<double>(runs_ - kFirst + 1, std::max<double>(kWarm, kScatterSamples / mean_length_));
}

/// The line takes up the run that has ended, by its last sample.
void SteadyClockFit::endRun() noexcept {
  const double end = residual_, step = end - end_residual_;
  end_residual_ = end;
  if (++runs_ == 1) return;  // the first one is the line's beginning
  mean_length_ += (run_length_ - mean_length_) / std::min<double>(runs_, kScatterSamples);
  const double n = std::min<double>(runs_, kMemorySamples / mean_length_);
  double used = end;
  if (runs_ >= kWarm) {
    const double most = kClip * std::max(std::sqrt(end_square_), kExact * interval_);
    used = std::clamp(used, -most, most);
  }
  instant_ += used * 2.0 * (2.0 * n - 1.0) / (n * (n + 1.0));
  interval_ = std::max(0.0, interval_ + used / run_length_ * 6.0 / (n * (n + 1.0)));
  if (runs_ < kFirst) return;
  const double gain = scatterGain();
  end_square_ += gain * (square(used) - end_square_);
  step_square_ += gain * (square(step) - step_square_);
}

/// The line, by whole intervals.
void SteadyClockFit::shift(double intervals) noexcept {
  lost_evidence_ = gained_evidence_ = 0.0;
  instant_ += intervals * interval_;
  residual_ -= intervals * interval_;
  end_residual_ -= intervals * interval_;
}

/// residual: of a run's first sample. Shifts the line by whole intervals.
void SteadyClockFit::watchLost(double residual) noexcept {
  if (runs_ < kFirst) {
    start_mean_ = residual;
    return;
  }
  double off = residual - start_mean_;
  if (runs_ >= kWarm && interval_ > 0.0) {
    const double scatter = std::max(std::sqrt(start_variance_), kLeastScatter * interval_);
    const double per_interval = interval_ / square(scatter);
    lost_evidence_ = std::max(0.0, lost_evidence_ + per_interval * (off - 0.5 * interval_));
    gained_evidence_ = std::max(0.0, gained_evidence_ + per_interval * (-off - 0.5 * interval_));
    double shift = 0.0;
    if (off > kGap * scatter + 2.0 * interval_)
      shift = std::nearbyint(off / interval_);
    else if (lost_evidence_ > kEvidence)
      shift = std::max(1.0, std::nearbyint(off / interval_));
    else if (gained_evidence_ > kEvidence)
      shift = std::min(-1.0, std::nearbyint(off / interval_));
    if (shift != 0.0) {
      this->shift(shift);
      off -= shift * interval_;
    }
    off = std::clamp(off, -kClip * scatter, kClip * scatter);
  }
  const double gain = scatterGain();
  start_mean_ += gain * off;
  start_variance_ += gain * (square(off) - start_variance_);
}

std::int64_t SteadyClockFit::add(std::int64_t stamp) noexcept {
  const bool new_run = stamp != stamp_;
  stamp_ = stamp;
  const double now = static_cast<double>(stamp - origin_);
  if (new_run) endRun();
  instant_ += interval_;
  if (new_run) watchLost(now - instant_);
  residual_ = now - instant_;
  run_length_ = new_run ? 1 : run_length_ + 1;
  return origin_ + static_cast<std::int64_t>(std::llround(instant_));
}

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
