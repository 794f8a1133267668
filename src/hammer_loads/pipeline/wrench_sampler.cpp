#include "hammer_loads/pipeline/wrench_sampler.h"

#include <cmath>

#include "hammer_loads/pipeline/beside_blow.h"
#include "hammer_loads/pipeline/step_impulse.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

WrenchSampler::WrenchSampler(const HullModel& model, const CrankStep& step, const CrankTracker& tracker,
                             const PipelineSettings& settings)
    : model_(&model),
      step_(&step),
      tracker_(&tracker),
      kind_(settings.output),
      rate_(settings.output_rate),
      longest_gap_(settings.stale_after),
      near_blow_(settings.near_blow),
      torque_part_(settings.torque_deviation_part) {}

std::size_t WrenchSampler::mostOutputs() const noexcept {
  return static_cast<std::size_t>(std::ceil(rate_ * longest_gap_)) + 2;
}

/// Whether the first sample has an output: a mean has no interval yet.
bool WrenchSampler::begin(const SampleResult& result) noexcept {
  begun_ = true;
  origin_ = last_output_ = result.stamp;
  index_ = kind_ == OutputKind::kMean ? 1 : 0;
  impulse_ = {};
  momentum_deviation_ = {};
  return kind_ != OutputKind::kMean;
}

void WrenchSampler::sample(const LinksBeside& links, SampleResult& result) noexcept {
  added_up_to_ = 0.0;
  drive_ = driveReaction(*model_, tracker_->driveInertia());
  followHull(result.hull.motion);
  if (!begun_ && !begin(result)) return;
  StampNs stamp{};
  while (isDue(result.stamp, stamp)) {
    const WrenchOutput made = output(stamp, links, result);
    if (isKnown(made, result)) result.outputs.push_back(made);
    if (stamp == result.stamp) return;
  }
  if (kind_ == OutputKind::kMean) addUpTo(step_->length());
}

/// Whether it is clear on which side of the blow the output is; a mean does not depend on it.
bool WrenchSampler::isKnown(const WrenchOutput& output, const SampleResult& result) const noexcept {
  if (kind_ == OutputKind::kMean) return true;
  return output.stamp == result.stamp ? !result.beside_blow : !isBesideBlow(output.crank, output.deviation.angle);
}

/// Stamp of the next output, if it is not after the sample.
bool WrenchSampler::isDue(StampNs sample, StampNs& stamp) const noexcept {
  stamp = sample;
  if (rate_ > 0.0) {
    const double after = static_cast<double>(index_) * 1e9 / rate_;  // [ns]
    if (!(after <= static_cast<double>(kLastStamp))) return false;   // nor can it be told as a stamp
    stamp = origin_ + static_cast<StampNs>(std::llround(after));
  }
  return stamp <= sample;
}

void WrenchSampler::addUpTo(double time) noexcept {
  if (!(time > added_up_to_)) return;
  const LoadImpulse motion = motionImpulse(*model_, drive_, *step_, added_up_to_, time);
  const LoadImpulse added = addedImpulse(*model_, drive_, *step_, hull_, added_up_to_, time);
  impulse_ = {impulse_.all + motion.all + added.all, impulse_.drive_y + motion.drive_y + added.drive_y};
  added_up_to_ = time;
}

/// Of the step that the sample ends.
void WrenchSampler::followHull(const HullMotion& hull) noexcept {
  hull_.from = hull_.to;
  hull_.to = hull;
  hull_.length = step_->length();
  hull_.blow.reset();
  for (const CrankStep::Passage& passage : *step_)
    if (passage.strikes) hull_.blow = passage.time;
}

WrenchOutput WrenchSampler::output(StampNs stamp, const LinksBeside& links, const SampleResult& result) noexcept {
  ++index_;
  const bool at_sample = stamp == result.stamp;
  const double time = at_sample ? step_->length() : seconds(stamp - step_->start());
  const HullMotion hull = at_sample ? result.hull.motion : hull_.at(time);
  WrenchOutput output;
  output.stamp = stamp;
  output.crank = at_sample ? result.crank : step_->at(time);
  if (kind_ == OutputKind::kMean) {
    addUpTo(time);
    output.interval = seconds(stamp - last_output_);
    output.wrench = (1.0 / output.interval) * impulse_.all;
    output.drive_reaction_y = impulse_.drive_y / output.interval;
    impulse_ = {};
  } else {
    output.wrench = at_sample ? result.wrench : hullWrench(*model_, drive_, motionOf(output.crank), hull);
    const double drive_acceleration = output.crank.acceleration + output.crank.drive_lead_acceleration;
    output.drive_reaction_y = drive_.torque(drive_acceleration, hull.acceleration);
  }
  last_output_ = stamp;
  const LinkState state = at_sample ? result.links : linkState(*model_, motionOf(output.crank));
  output.near_blow = state.transmission_angle < near_blow_;
  const Eigen::Matrix3d covariance =
      at_sample ? result.crank_covariance : tracker_->covarianceBetween(time, torque_part_);
  const HullState::Motion moving{hull, result.hull.moves, result.hull.covariance};
  if (at_sample)
    addDeviation(links, moving, covariance, output);
  else
    addDeviation(LinksBeside(*model_, linksAt(*model_, output.crank.position.angle)), moving, covariance, output);
  return output;
}

/// Errors of crank and IMU are independent.
void WrenchSampler::addHullMotion(const LinksBeside& links, const HullState::Motion& hull,
                                  WrenchOutput& output) const noexcept {
  if (hull.covariance.isZero(0.0)) return;
  const HullWrench variance =
      hullMotionVariance(*model_, drive_, links.here.links, output.crank.speed, hull.motion, hull.covariance);
  HullWrench& d = output.deviation.wrench;
  d = {std::sqrt(square(d.force_x) + variance.force_x), std::sqrt(square(d.force_z) + variance.force_z),
       std::sqrt(square(d.torque_y) + variance.torque_y)};
}

void WrenchSampler::addDeviation(const LinksBeside& links, const HullState::Motion& hull,
                                 const Eigen::Matrix3d& covariance, WrenchOutput& output) noexcept {
  output.deviation = hullDeviation(*model_, drive_, output.crank, links, hull.motion, covariance);
  addHullMotion(links, hull, output);
  if (kind_ != OutputKind::kMean) return;
  const HullWrench momentum = momentumDeviation(*model_, drive_, output.crank, links, covariance);
  const HullWrench allowed = (1.0 / output.interval) * (momentum_deviation_ + momentum);
  momentum_deviation_ = momentum;
  HullWrench& wrench = output.deviation.wrench;
  wrench = {std::fmin(wrench.force_x, allowed.force_x), std::fmin(wrench.force_z, allowed.force_z),
            std::fmin(wrench.torque_y, allowed.torque_y)};
}

}  // namespace hammer_loads
