#include "hammer_loads/pipeline/life_follower.h"

#include <algorithm>
#include <utility>

#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kKnown =
    gate::kRare;  // deviations from the blow; closer loads are not counted, as no reading determines them

}  // namespace

/// The hull's channels at the sample that ends a step.
struct LifeFollower::StepEnd {
  explicit StepEnd(const SampleResult& result) noexcept {
    wrenchValues(result.wrench, value.data());
    wrenchValues(result.ofExtreme().deviation, deviation.data());
    wrenchValues(result.deviation.common(), common.data());
  }
  std::array<double, kHullChannels> value, deviation, common;
};

LifeFollower::LifeFollower(const Pipeline& pipeline, const life::LifeSettings& settings)
    : pipeline_(&pipeline),
      boom_(pipeline.boom() ? &pipeline.boom()->boom() : nullptr),
      channels_(channelNames(boom_)),
      recorder_(settings, channels_),
      turn_(channels_.size()),
      values_(channels_.size()),
      deviations_(channels_.size()),
      common_(channels_.size()),
      between_(channels_.size(), kNaN),
      deviations_there_(between_),
      common_there_(between_) {
  if (settings.bandwidth > 0.0) means_.emplace(pipeline, settings.bandwidth, channels_.size());
  turns_.fill(life::TurnLoadsRecorder(channels_.size()).endTurn(-1));
}

bool LifeFollower::due() const noexcept {
  const SampleResult& result = pipeline_->result();
  return !result.refusal && recorder_.due(result.stamp);
}

life::LifePiece LifeFollower::take() {
  life::LifePiece piece = recorder_.take();
  if (total_) {
    total_->advance(piece);
  } else {
    total_ = piece;
  }
  return piece;
}

void LifeFollower::follow() noexcept {
  const SampleResult& result = pipeline_->result();
  const bool counts = pipeline_->zeroWatch().mayCount(pipeline_->crank().tracker());
  if (!counts) last_.reset();
  if (!result.refusal && counts) {
    const CrankStep& step = pipeline_->crank().step();
    const bool goes_on = last_ && step.known() && step.start() == *last_;
    if (goes_on && !result.uncertain && !uncertain_) {
      followStep(result);
    } else if (goes_on) {
      for (const CrankStep::Passage& passage : step)
        if (passage.may_strike) endTurn(step.stampAt(passage.time));
    } else {
      recorder_.gap();
      turn_.restart();
      if (means_) means_->restart();
    }
    count(result);
    last_ = result.stamp;
    uncertain_ = result.uncertain;
    if (!since_) since_ = last_;
  }
  confirmTurns(result);
}

void LifeFollower::count(const SampleResult& result) noexcept {
  channelValues(result, boom_, values_.data(), deviations_.data(), common_.data());
  if (means_)
    means_->sample(values_.data(), deviations_.data(), common_.data(),
                   [this](StampNs stamp, const double* values, const double* deviations, const double* common) {
                     recorder_.sample(stamp, values, deviations, common);
                   });
  if (!result.isPublished()) return;
  if (!means_) recorder_.sample(result.stamp, values_.data(), deviations_.data(), common_.data());
  turn_.add(result.stamp, values_.data(), deviations_.data(), common_.data());
}

void LifeFollower::followStep(const SampleResult& result) noexcept {
  if (pipeline_->elastic().ranOverStep()) return followRing(result);
  const CrankStep& step = pipeline_->crank().step();
  const DriveReaction drive = driveReaction(pipeline_->model(), step.driveInertia());
  const StepLoad load{pipeline_->model(), drive, result.hull.motion};
  const StepEnd end(result);
  forEachStepExtreme(
      load, step,
      [&](StepPlace place, CrankEstimate crank) {
        if (!moveToKnown(place, crank)) return;
        wrenchValues(load.at(crank), between_.data());
        keepWhatBothEndsSay(load, place, crank, end);
        countBetween(step.stampAt(place.time));
      },
      [&](double time) { endTurn(step.stampAt(time)); });
}

void LifeFollower::countBetween(StampNs stamp) noexcept {
  if (!means_) recorder_.between(stamp, between_.data(), deviations_there_.data(), common_there_.data());
  turn_.add(stamp, between_.data(), deviations_there_.data(), common_there_.data());
}

/// Counts the load between samples with an elastic rod: the extremes of its path, if the path reaches the second sample
/// within the deviations published at both. A load just before a blow has the deviation of the sample there.
void LifeFollower::followRing(const SampleResult& result) noexcept {
  const CrankStep& step = pipeline_->crank().step();
  const ElasticFollower& rod = pipeline_->elastic();
  const DriveReaction drive = driveReaction(pipeline_->model(), step.driveInertia());
  const StepEnd end(result);
  std::array<double, kHullChannels> expected;
  wrenchValues(rod.byBodies(step.length(), drive, result.hull.motion).wrench, expected.data());
  const int count = partsOf(step.length(), kRingStep);
  const bool strikes = rod.filter().blowOfStep().has_value();
  const CrankStep::Passage* passage = step.begin();
  const auto endTurnsUntil = [&](double time) {
    for (; passage != step.end() && passage->time <= time; ++passage)
      if (passage->may_strike) endTurn(step.stampAt(passage->time));
  };
  for (int i = 1; i < count; ++i) {
    const double time = step.length() * i / count;
    endTurnsUntil(time);
    if (rod.isBesideBlowAt(time)) continue;
    const ElasticFollower::Instant there = rod.byBodies(time, drive, result.hull.motion);
    wrenchValues(there.wrench, between_.data());
    const bool in_front = strikes && there.bodies.angle.side == Side::kBeforeBlow;
    for (std::size_t k = 0; k < kHullChannels; ++k) {
      const auto [least, greatest] = std::minmax(values_[k], end.value[k]);
      if (!(std::abs(expected[k] - end.value[k]) <= ownOfBoth(k, end)))
        between_[k] = std::clamp(between_[k], least, greatest);
      const double last = strikes ? 0.0 : deviations_[k], last_common = strikes ? 0.0 : common_[k];
      deviations_there_[k] = in_front ? deviations_[k] : std::max(last, end.deviation[k]);
      common_there_[k] = in_front ? common_[k] : std::max(last_common, end.common[k]);
    }
    countBetween(step.stampAt(time));
  }
  endTurnsUntil(step.length());
}

/// Moves a place that is closer to the blow than the uncertainty of the crank angle to where the sides of the blow are
/// known. Closer loads are not counted, like a sample there. Returns false if that place is not in the step.
bool LifeFollower::moveToKnown(StepPlace& place, CrankEstimate& crank) const noexcept {
  const CrankStep& step = pipeline_->crank().step();
  const double deviation = deviationFromBlow(pipeline_->crank().tracker(), pipeline_->result().deviation.angle);
  if (!isBesideBlow(crank, kKnown * deviation)) return true;
  if (place.passage == nullptr) return false;
  const bool earlier = place.passage->forward == (place.side == Side::kBeforeBlow);
  place = {place.time + (earlier ? -1.0 : 1.0) * kKnown * deviation / std::abs(crank.speed)};
  if (!(place.time > 0.0 && place.time < step.length())) return false;
  crank = step.at(place.time);
  return true;
}

/// Limits a load beyond those at both ends. It is kept if the paths from both ends agree within the deviations
/// published there. Constants are excluded, since they act equally on both paths. Otherwise it is kept as far as both
/// paths have it: a sample that corrects the path makes neither of them valid in between.
void LifeFollower::keepWhatBothEndsSay(const StepLoad& load, const StepPlace& place, const CrankEstimate& crank,
                                       const StepEnd& end) noexcept {
  std::copy_n(deviations_.begin(), kHullChannels, deviations_there_.begin());
  std::copy_n(common_.begin(), kHullChannels, common_there_.begin());
  const auto isWithin = [&](std::size_t i) {
    return between_[i] >= std::min(values_[i], end.value[i]) && between_[i] <= std::max(values_[i], end.value[i]);
  };
  bool all_within = true;
  for (std::size_t i = 0; i < kHullChannels; ++i) all_within = all_within && isWithin(i);
  if (all_within) return;
  const CrankStep& step = pipeline_->crank().step();
  const HullDeviation there = pipeline_->stepDeviation(place.time, crank);
  wrenchValues(there.wrench(), deviations_there_.data());
  wrenchValues(there.common(), common_there_.data());
  std::array<double, kHullChannels> forward, back;
  const std::optional<CrankPaths> paths = place.paths(step);
  if (paths) {
    wrenchValues(load.at(paths->forward), forward.data());
    wrenchValues(load.at(paths->back), back.data());
  }
  for (std::size_t i = 0; i < kHullChannels; ++i) {
    const auto [least, greatest] = std::minmax(values_[i], end.value[i]);
    if (paths && std::abs(forward[i] - back[i]) <= ownOfBoth(i, end)) continue;
    const double above = paths ? std::max(0.0, std::min(forward[i], back[i]) - greatest) : 0.0;
    const double below = paths ? std::max(0.0, least - std::max(forward[i], back[i])) : 0.0;
    between_[i] = std::clamp(between_[i], least - below, greatest + above);
  }
}

/// Returns the sum of a channel's standard deviations at both ends of the step, without constants.
double LifeFollower::ownOfBoth(std::size_t i, const StepEnd& end) const noexcept {
  return life::LoadError::at(i, deviations_.data(), common_.data()).own +
         life::LoadError::at(i, end.deviation.data(), end.common.data()).own;
}

/// Ends a revolution; it becomes known later whether it ended with a blow.
void LifeFollower::endTurn(StampNs stamp) noexcept {
  turns_[next_turn_] = turn_.endTurn(stamp);
  next_turn_ = (next_turn_ + 1) % turns_.size();
}

/// Confirms revolutions. A revolution is not whole if the blow that began it has been revised.
void LifeFollower::confirmTurns(const SampleResult& result) noexcept {
  for (std::size_t i = 0; i < result.turn_ends; ++i) {
    if (!result.ends[i].blow.impossible) recorder_.turn();
    for (life::TurnLoads& turn : turns_) {
      if (turn.end == result.ends[i].stamp) turn.whole = turn.whole && last_blow_ == turn.start;
    }
    last_blow_ = result.ends[i].stamp;
  }
}

const life::TurnLoads* LifeFollower::turnLoads(const TurnEnd& end) const noexcept {
  const auto found =
      std::find_if(turns_.begin(), turns_.end(), [&](const life::TurnLoads& turn) { return turn.end == end.stamp; });
  return found == turns_.end() ? nullptr : &*found;
}

}  // namespace hammer_loads
