#include "hammer_loads/pipeline/wrench_sampler.h"

#include <cmath>

#include "hammer_loads/pipeline/step_impulse.h"

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

void WrenchSampler::sample(SampleResult& result) noexcept {
  added_up_to_ = 0.0;
  drive_ = driveReaction(*model_, tracker_->driveInertia());
  if (!begun_ && !begin(result)) return;
  StampNs stamp{};
  while (isDue(result.stamp, stamp)) {
    result.outputs.push_back(output(stamp, result));
    if (stamp == result.stamp) return;
  }
  if (kind_ == OutputKind::kMean) addUpTo(step_->length(), result.hull.motion);
}

/// Stamp of the next output, if it is not after the sample.
bool WrenchSampler::isDue(StampNs sample, StampNs& stamp) const noexcept {
  stamp = sample;
  if (rate_ > 0.0) stamp = origin_ + static_cast<StampNs>(std::llround(static_cast<double>(index_) * 1e9 / rate_));
  return stamp <= sample;
}

void WrenchSampler::addUpTo(double time, const HullMotion& hull) noexcept {
  if (!(time > added_up_to_)) return;
  const LoadImpulse motion = motionImpulse(*model_, drive_, *step_, added_up_to_, time);
  const double drive_y = drive_.torque(0.0, hull.acceleration) * (time - added_up_to_);
  impulse_.all =
      impulse_.all + motion.all + addedImpulse(*model_, *step_, hull, added_up_to_, time) + HullWrench{0, 0, drive_y};
  impulse_.drive_y += motion.drive_y + drive_y;
  added_up_to_ = time;
}

WrenchOutput WrenchSampler::output(StampNs stamp, const SampleResult& result) noexcept {
  const HullMotion& hull = result.hull.motion;
  ++index_;
  const bool at_sample = stamp == result.stamp;
  const double time = at_sample ? step_->length() : seconds(stamp - step_->start());
  WrenchOutput output;
  output.stamp = stamp;
  output.crank = at_sample ? result.crank : step_->at(time);
  if (kind_ == OutputKind::kMean) {
    addUpTo(time, hull);
    output.interval = seconds(stamp - last_output_);
    output.wrench = (1.0 / output.interval) * impulse_.all;
    output.drive_reaction_y = impulse_.drive_y / output.interval;
    impulse_ = {};
  } else {
    output.wrench = at_sample ? result.wrench : hullWrench(*model_, drive_, motionOf(output.crank), hull);
    output.drive_reaction_y = drive_.torque(output.crank.acceleration, hull.acceleration);
  }
  last_output_ = stamp;
  output.near_blow = linkState(*model_, motionOf(output.crank)).transmission_angle < near_blow_;
  addDeviation(hull, at_sample, output);
  return output;
}

void WrenchSampler::addDeviation(const HullMotion& hull, bool at_sample, WrenchOutput& output) noexcept {
  const Eigen::Matrix3d covariance =
      at_sample ? tracker_->motionCovariance(torque_part_)
                : tracker_->covarianceBetween(seconds(output.stamp - step_->start()), torque_part_);
  output.deviation = hullDeviation(*model_, drive_, output.crank, hull, covariance);
  if (kind_ != OutputKind::kMean) return;
  const HullWrench momentum = momentumDeviation(*model_, drive_, output.crank, covariance);
  const HullWrench allowed = (1.0 / output.interval) * (momentum_deviation_ + momentum);
  momentum_deviation_ = momentum;
  HullWrench& wrench = output.deviation.wrench;
  wrench = {std::fmin(wrench.force_x, allowed.force_x), std::fmin(wrench.force_z, allowed.force_z),
            std::fmin(wrench.torque_y, allowed.torque_y)};
}

}  // namespace hammer_loads
