#include "hammer_loads/crank/stamp_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kMemorySamples = 4096.0;   // samples
constexpr double kScatterSamples = 300.0;   // samples for the identification of scatter, but at least kWarm runs
constexpr int kWarm = 20;                   // runs after which the line can judge stamps
constexpr int kUnsure = 300;                // stamps that may show a miscount before them, despite jitter
constexpr int kFewest = 3;                  // runs after which a loss is visible
constexpr int kTries = 4;                   // resets of a line for a loss, as jitter looks alike
constexpr int kFirst = 4;                   // runs until there is a line
constexpr int kKnown = 6;                   // runs until regular bursts are recognised
constexpr double kAlone = 1.02;             // mean samples per stamp: stamps do not repeat
constexpr double kBurst = 2.0;              // mean samples per stamp: stamps come in bursts
constexpr double kRegular = 0.1;            // scatter of bursts over the time between them
constexpr double kClip = gate::kVeryRare;   // root mean squares at which a residual is clipped
constexpr double kExact = 0.01;             // part of the interval: scatter assumed for exact stamps
constexpr double kGap = gate::kImpossible;  // root mean squares: a later stamp is not scatter
constexpr double kEvidence = 16.0;          // logarithm of the likelihood ratio of a loss: by chance in 14 h at 1 kHz
constexpr double kOneStamp = 0.3;           // part of it that a single stamp contributes: drivers are late occasionally
constexpr double kLeastIndependence = 0.2;
constexpr double kNoLoss = 3.0;         // logarithm of the odds that none was lost: 20 to 1
constexpr double kLeastScatter = 0.15;  // part of the interval: a run's beginning is not known better
constexpr double kBent = 0.2;           // part of the line's memory: range of the linear correction
constexpr double kGrown = 2.0;          // scatter about the line relative to white jitter with such steps

// Limits of the sequence.
constexpr double kMany = 5.0;              // irregular stamps in a thousand: more than a single late message
constexpr double kHeldUp = 0.1;            // part of the interval: a message that waited behind a late one
constexpr double kSingle = 1.5;            // irregular stamps in a thousand: a single one
constexpr std::int64_t kLeastStep = 1000;  // [ns] between instants where stamps repeat and no interval is known
// Numerical: kExact, kLeastStep

}  // namespace

void SteadyClockFit::begin(std::int64_t stamp) noexcept {
  *this = SteadyClockFit{};
  origin_ = stamp_ = stamp;
  run_length_ = 1;
  unsure_stamps_ = kUnsure;
}

bool SteadyClockFit::isKnown() const noexcept { return runs_ >= kKnown; }

bool SteadyClockFit::inBursts() const noexcept { return mean_length_ > kBurst; }

bool SteadyClockFit::explains() const noexcept {
  if (isKnown() && inBursts() && end_square_ < square(kRegular * mean_length_ * interval_)) return true;
  return runs_ >= kWarm && interval_ > 0.0 && end_square_ <= square(kGrown) * 0.5 * step_square_;
}

double SteadyClockFit::lateness() const noexcept {
  const bool is_late = runs_ >= kWarm && mean_length_ < kAlone && exceeds(residual_, end_square_, kGap);
  return is_late ? std::max(0.0, residual_) : 0.0;
}

bool SteadyClockFit::contradictsLoss() const noexcept {
  return interval_ / end_square_ * (0.5 * interval_ - residual_) > kNoLoss;
}

double SteadyClockFit::scatterGain() const noexcept {
  return 1.0 / std::min<double>(runs_ - kFirst + 1, std::max<double>(kWarm, kScatterSamples / mean_length_));
}

void SteadyClockFit::confirm(bool counted) noexcept {
  unsure_stamps_ = counted ? std::max(0, unsure_stamps_ - 1) : kUnsure;
}

/// Updates the line by the run that has ended, with its last sample.
void SteadyClockFit::endRun() noexcept {
  const double end = residual_, step = end - end_residual_;
  end_residual_ = end;
  if (++runs_ == 1) return;  // the first one is the line's beginning
  mean_length_ += (run_length_ - mean_length_) / std::min<double>(runs_, kScatterSamples);
  const double n = remembered_ = std::min(remembered_ + 1.0, kMemorySamples / mean_length_);
  const double used = runs_ >= kWarm ? std::clamp(end, -mostUsed(), mostUsed()) : end;
  instant_ += used * 2.0 * (2.0 * n - 1.0) / (n * (n + 1.0));
  interval_ = std::max(0.0, interval_ + used / run_length_ * 6.0 / (n * (n + 1.0)));
  if (runs_ < kFirst) return;
  const double gain = scatterGain();
  end_square_ += gain * (square(used) - end_square_);
  step_square_ += gain * (square(step) - step_square_);
  end_mean_ += gain * (used - end_mean_);
  if (mean_length_ < kAlone && exceeds(end_mean_, end_square_ / (kScatterSamples * independence()), gate::kImpossible))
    remembered_ = std::min(remembered_, kScatterSamples);  // undetected losses have bent the line
}

/// Bound to which residuals are clipped [ns].
double SteadyClockFit::mostUsed() const noexcept {
  return kClip * std::max(std::sqrt(end_square_), kExact * interval_);
}

/// Moves the line [ns].
void SteadyClockFit::move(double by) noexcept {
  instant_ += by;
  residual_ -= by;
  end_residual_ -= by;
}

/// Applies a loss that the readings show; the evidence of the stamps for another one is kept.
void SteadyClockFit::skip(double intervals) noexcept {
  move(intervals * interval_);
  if (mean_length_ >= kAlone) lost_ = gained_ = {};
}

/// Weight of a stamp: correlated lateness of successive stamps is less information than independent lateness.
double SteadyClockFit::independence() const noexcept {
  const double alike = end_square_ > 0.0 ? std::clamp(1.0 - 0.5 * step_square_ / end_square_, 0.0, 1.0) : 0.0;
  return std::max(kLeastIndependence, (1.0 - alike) / (1.0 + alike));  // a loss correlates them as well
}

/// Adds the evidence of a stamp. off: its lateness; step: from the previous one. A stamp that follows a late one at
/// once was delayed by it and gives no information on lost samples. A single stamp suffices if stamps repeat, as the
/// last sample of each waited least.
void SteadyClockFit::gatherEvidence(double off, double scatter, double step) noexcept {
  const bool repeats = mean_length_ >= kAlone;
  const bool held_up = is_late_ && step < 0.5 * interval_ && !repeats;
  is_late_ = off > kGap * scatter || (held_up && off > 0.5 * interval_);
  const bool is_fine = runs_ > square(2.0 * scatter / (kLeastScatter * interval_));  // the line is accurate at its end
  if (!repeats && (unsure_stamps_ == 0 || !is_fine)) return;
  const double per_interval = (repeats ? 1.0 : independence()) * interval_ / square(scatter);
  const double most = repeats ? kEvidence + 1.0 : kOneStamp * kEvidence;
  const auto by = [&](double late) { return std::min(per_interval * (late - 0.5 * interval_), most); };
  if (!held_up) lost_.add(by(off), off);
  gained_.add(by(-off), off);
}

/// Corrects a count that is off by whole intervals; returns the move of the line [ns]. The stamps since the miscount
/// have already moved and tilted the line by a part of it, which is subtracted.
double SteadyClockFit::correctCount() noexcept {
  const bool is_lost = lost_.logarithm > kEvidence;
  if (!is_lost && !(gained_.logarithm > kEvidence)) return 0.0;
  const Evidence& evidence = is_lost ? lost_ : gained_;
  const double whole = std::nearbyint(evidence.mean / interval_);
  const double by = (is_lost ? std::max(1.0, whole) : std::min(-1.0, whole)) * interval_;
  const double part = std::min(kBent, (evidence.stamps - 1) / remembered_), most = mostUsed();
  const double used = std::clamp(evidence.mean, -most, most);
  move(by - 4.0 * part * used);
  interval_ = std::max(0.0, interval_ - 6.0 * part * used / (remembered_ * mean_length_));
  lost_ = gained_ = {};
  return by;
}

/// Returns true if a sample was lost within the bursts that the line begins with, which cannot count it yet. Jitter
/// looks alike. After a shorter burst the readings of a slow crank were taken for duplicates.
bool SteadyClockFit::lostWhileUnknown(double residual) const noexcept {
  if (begun_ == kTries || runs_ < kFewest || runs_ >= kKnown || !inBursts()) return false;
  return run_length_ == longest_ && std::abs(residual - start_mean_) > 0.5 * interval_;
}

/// Corrects the count of samples. residual: that of a run's first sample; step: from the previous stamp to its own.
void SteadyClockFit::watchLost(double residual, double step) noexcept {
  if (lostWhileUnknown(residual)) {
    const int begun = begun_ + 1;
    begin(stamp_);
    begun_ = begun;
    return;
  }
  if (runs_ < kFirst) {
    start_mean_ = residual;
    return;
  }
  double off = residual - start_mean_;
  // Bursts that scatter by less than a third of an interval show a loss by one stamp.
  const bool are_exact = isKnown() && inBursts() && start_variance_ < square(2.0 * kLeastScatter * interval_);
  if ((runs_ >= kWarm || are_exact) && interval_ > 0.0) {
    const double scatter = std::max(std::sqrt(start_variance_), kLeastScatter * interval_);
    gatherEvidence(off, scatter, step);
    const double moved = correctCount();
    moved_back_ = moved < 0.0;
    off -= moved;
    suspected_ = std::max(0.0, std::nearbyint(off / interval_));
    off = std::clamp(off, -kClip * scatter, kClip * scatter);
  }
  const double gain = scatterGain();
  start_mean_ += gain * off;
  start_variance_ += gain * (square(off) - start_variance_);
}

std::int64_t SteadyClockFit::add(std::int64_t stamp) noexcept {
  const bool new_run = stamp != stamp_;
  const auto step = static_cast<double>(stamp - std::exchange(stamp_, stamp));
  suspected_ = 0.0;
  moved_back_ = false;
  const double now = static_cast<double>(stamp - origin_);
  if (new_run) endRun();
  instant_ += interval_;
  if (new_run) watchLost(now - instant_, step);
  residual_ = static_cast<double>(stamp - origin_) - instant_;
  run_length_ = new_run ? 1 : run_length_ + 1;
  longest_ = std::max(longest_, run_length_);
  return origin_ + static_cast<std::int64_t>(std::llround(instant_));
}

StampSequence::StampSequence(CrankStamps mode, double stale_after) noexcept
    : mode_(mode), stale_(static_cast<std::int64_t>(std::llround(stale_after * 1e9))) {}

StampSequence::Place StampSequence::begin(std::int64_t header) noexcept {
  awaits_line_ = steady_ && fit_.inBursts();
  header_ = newest_ = placed_ = header;
  rewound_.reset();
  irregularity_ = 0.0;
  uncounted_ = false;
  error_before_restart_ = steady_ ? 1e-9 * (awaits_line_ ? fit_.scatter() : fit_.stampError()) : 0.0;
  steady_ = mode_ == CrankStamps::kSteady;
  fit_.begin(header);
  return {awaits_line_ ? Kind::kDuplicate : Kind::kRestart, header};
}

StampSequence::Place StampSequence::place(std::int64_t header, Repeats repeats) noexcept {
  if (!header_) return begin(header);
  const bool may_be_burst = repeats == Repeats::kWithinCount || (repeats == Repeats::kAtRest && !doubled_);
  if (header == *header_ && repeats != Repeats::kNo && !(may_be_burst && irregularity_ > kMany)) {
    uncounted_ = uncounted_ || repeats != Repeats::kAtWork;
    if (repeats == Repeats::kAtWork && !std::exchange(doubled_, true)) fit_.begin(header);  // the fit may contain some
    return {Kind::kDuplicate, header};
  }
  const std::int64_t back = newest_ - header;
  const bool too_far = mode_ == CrankStamps::kHeader ? back > 0 : back > stale_;
  if (too_far) {  // a single one may just be late
    const bool again = rewound_ && header > *rewound_;
    rewound_ = header;
    return again ? begin(header) : Place{Kind::kOutOfOrder, header};
  }
  if (mode_ == CrankStamps::kHeader && back == 0) return {Kind::kDuplicate, header};
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
  if (uncounted_ && repeats) {  // no duplicates: stamps come in bursts
    fit_.begin(header);
    uncounted_ = false;
  }
  const std::int64_t fitted = fit_.add(header);
  const bool irregular = header <= newest_;
  const bool held_up = header > fitted && static_cast<double>(header - newest_) < kHeldUp * fit_.interval();
  irregular_ += irregular;
  irregularity_ += (irregular || held_up ? 1.0 : 0.0) - irregularity_ / look_back::kManyReadings;
  header_ = header;
  newest_ = std::max(newest_, header);
  if (mode_ == CrankStamps::kAuto && irregularity_ > kMany && fit_.explains()) steady_ = true;
  const bool knows = fit_.isKnown() && (steady_ || !fit_.inBursts());
  awaits_line_ = awaits_line_ && !(knows && fit_.explains()) && fit_.runs() < kWarm;
  const bool single = irregularity_ < kSingle && fit_.runs() > 0;  // a single repetition is no burst
  if (awaits_line_ || (repeats && !knows && !single)) return {Kind::kDuplicate, header};
  std::int64_t instant = header;
  if (steady_) {
    instant = fitted;
  } else if (header <= placed_) {
    const auto half = static_cast<std::int64_t>(0.5 * fit_.interval());
    instant = std::min(fitted, placed_ + std::max(half, kLeastStep));
  }
  is_crowded_ = instant <= placed_;
  placed_ = instant > placed_ ? instant : placed_ + kLeastStep;
  return {Kind::kPlaced, placed_};
}

}  // namespace hammer_loads
