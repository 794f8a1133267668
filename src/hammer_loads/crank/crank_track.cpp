#include "hammer_loads/crank/crank_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/crank/belief_smoothing.h"

namespace hammer_loads {
namespace {

// Of the live filter's share of the sensor's errors that are not seen: its noise covers more of the rest.
constexpr double kUnseenGrowth = 1.8;
// Guard: CrankTrack.CountsMoreOfTheSensorAndLessOfTheSupplyThanLive of kUnseenGrowth

}  // namespace

CrankTrack::CrankTrack(const Mechanism& mechanism, Level level, double drive_inertia,
                       const CrankFilterSettings& settings, const std::optional<Coupling>& coupling)
    : mechanism_(mechanism), model_(mechanism_, level, coupling), filter_(model_, drive_inertia, settings) {}

void CrankTrack::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  filter_.setHullMotion(hull);
}

void CrankTrack::start(const CrankSample& sample) {
  filter_.start(sample);
  add({Tracking::kRestarted, 0.0, 0.0, model_.hullMotion(), {}, {}, {}});
}

Tracking CrankTrack::update(double dt, const CrankSample& sample) {
  TrackedSample tracked{{}, dt, 0.0, blend(hull_, model_.hullMotion(), 0.5), filter_.walks(), filter_.blowPrior(), {}};
  tracked.tracking = filter_.update(dt, sample);
  tracked.lost_time = filter_.lostTime();
  tracked.step += tracked.lost_time;
  add(tracked);
  return tracked.tracking;
}

void CrankTrack::considerRod(double angle, double speed) noexcept {
  filter_.considerRod(angle, speed);
  if (!samples_.empty()) samples_.back().belief = filter_.belief();
}

/// sample: what the filter's step began with, and how it ended.
void CrankTrack::add(TrackedSample sample) {
  if (sample.tracking == Tracking::kRevised) revise();
  sample.belief = filter_.belief();
  sample.growth = filter_.growth();
  sample.root = std::sqrt(kUnseenGrowth) * filter_.constantErrors().root();
  sample.consistency = filter_.consistency();
  sample.strike_consistency = filter_.strikeConsistency();
  sample.resolution = filter_.angleResolution();
  sample.slips = filter_.slips();
  sample.has_speed = filter_.hasSpeed();
  sample.is_plausible = filter_.isPlausible();
  sample.is_proven = filter_.isProven();
  sample.is_doubtful = filter_.isDoubtful();
  sample.reading_shows_side = filter_.readingShowsSide();
  sample.is_exact = filter_.timingNoise() == 0.0;
  samples_.push_back(sample);
  if (sample.tracking == Tracking::kOutlier) return;
  hull_ = model_.hullMotion();
  span_ += sample.step;
  if (span_ < kWindow + kOverlap) return;
  double left = span_;
  std::size_t count = ready_;
  while (left > kOverlap) left -= samples_[count].tracking == Tracking::kOutlier ? 0.0 : samples_[count].step, ++count;
  smooth(count);
  span_ = left;
}

/// Since the last blow the estimate was on the wrong branch.
void CrankTrack::revise() noexcept {
  for (std::size_t i = samples_.size(); i > ready_ + 1; --i) {
    TrackedSample& sample = samples_[i - 1];
    sample.was_wrong = sample.is_doubtful = true;
    const CrankPosition &at = sample.belief.state.position, &from = samples_[i - 2].belief.state.position;
    if (sample.tracking != Tracking::kContinued || at.blowsPassed() != from.blowsPassed()) return;
  }
}

/// Makes the first `count` samples ready by all that are there.
void CrankTrack::smooth(std::size_t count) {
  TrackedSample later;  // as the filter left it
  CrankBelief next;     // the same, smoothed
  bool is_last = true, is_cut = false;
  for (std::size_t i = samples_.size(); i > ready_; --i) {
    TrackedSample& sample = samples_[i - 1];
    if (sample.tracking == Tracking::kOutlier) continue;
    const bool is_doubtful = is_cut && isNearTool(later.belief.state, later.step);
    const std::optional<CrankBelief> smoothed = is_last || is_doubtful ? std::nullopt : before(sample, later, next);
    is_cut = !smoothed;
    const double next_factor = next.factor;
    later = sample;
    next = smoothed.value_or(sample.belief);
    if (i <= count) sample.belief = is_last ? next : settled(sample, next, next_factor);
    is_last = false;
  }
  ready_ = count;
}

std::optional<CrankBelief> CrankTrack::before(const TrackedSample& sample, const TrackedSample& later,
                                              const CrankBelief& next) const noexcept {
  if (later.tracking != Tracking::kContinued || later.was_wrong != sample.was_wrong) return std::nullopt;
  const FilterStep step{later.step, later.hull, later.prior, later.walks, filter_.mostSpeed()};
  return smoothedBelief(model_, step, sample.belief, later.belief, next);
}

/// On a branch where a crank can be. next_factor: of the smoothed sample after it.
CrankBelief CrankTrack::settled(const TrackedSample& sample, const CrankBelief& smoothed,
                                double next_factor) const noexcept {
  CrankBelief result = smoothed;
  CrankPosition& position = result.state.position;
  if (!position.isMirrored() || sample.belief.state.position.isMirrored()) return result;
  if (sample.is_exact) {
    position.angle.offset = 0.0;
  } else {
    settleBranch(model_, position.angle.side == Side::kAfterBlow ? result.factor : next_factor, result);
  }
  return result;
}

void CrankTrack::close() {
  smooth(samples_.size());
  closed_ = true;
}

TrackedSample CrankTrack::take() {
  TrackedSample sample = std::move(samples_.front());
  samples_.pop_front();
  --ready_;
  return sample;
}

}  // namespace hammer_loads
