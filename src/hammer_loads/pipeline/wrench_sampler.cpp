#include "hammer_loads/pipeline/wrench_sampler.h"

#include <cmath>

#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/step_impulse.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

/// Sets the variances and keeps the correlations.
void setVariances(const Eigen::Vector3d& variances, Eigen::Matrix3d& covariance) noexcept {
  const Eigen::Array3d before = covariance.diagonal();
  const Eigen::Vector3d by = (before > 0.0).select(variances.array() / before, 0.0).sqrt();
  covariance = (by.asDiagonal() * covariance * by.asDiagonal()).eval();
  covariance.diagonal() = variances;
}

}  // namespace

WrenchSampler::WrenchSampler(const HullModel& model, const WrenchColumns& columns, const CrankStep& step,
                             const CrankFilter& tracker, const ElasticFollower& elastic,
                             const PipelineSettings& settings)
    : model_(&model),
      hammer_(&columns),
      step_(&step),
      tracker_(&tracker),
      elastic_(&elastic),
      kind_(settings.output),
      rate_(settings.output_rate),
      longest_gap_(settings.stale_after),
      near_blow_(settings.near_blow),
      torque_part_(settings.torque_std_part) {}

std::size_t WrenchSampler::mostOutputs() const noexcept {
  return static_cast<std::size_t>(std::ceil(rate_ * longest_gap_)) + 2;
}

/// Returns true if the first sample has an output: a mean has no interval yet.
bool WrenchSampler::begin(const SampleResult& result) noexcept {
  begun_ = true;
  origin_ = last_output_ = result.stamp;
  index_ = kind_ == OutputKind::kMean ? 1 : 0;
  impulse_ = {};
  momentum_std_ = blow_deviation_ = {};
  column_impulse_.setZero();
  columns_ = result.load_columns;
  return kind_ != OutputKind::kMean;
}

void WrenchSampler::sample(const LinksForGradient& links, const SampleResult& result,
                           std::vector<WrenchOutput>& outputs) noexcept {
  added_up_to_ = 0.0;
  drive_ = driveReaction(*model_, tracker_->driveInertia());
  followStep(result);
  if (!begun_ && !begin(result)) return;
  StampNs stamp{};
  while (isDue(result.stamp, stamp)) {
    const WrenchOutput made = output(stamp, links, result);
    if (isKnown(seconds(stamp - step_->start()), made, result)) outputs.push_back(made);
    if (stamp == result.stamp) return;
  }
  if (kind_ == OutputKind::kMean) addUpTo(step_->length(), result);
}

/// Returns true if the side of the blow is certain at the output; a mean does not depend on it.
bool WrenchSampler::isKnown(double time, const WrenchOutput& output, const SampleResult& result) const noexcept {
  if (kind_ == OutputKind::kMean) return true;
  if (output.stamp == result.stamp) return result.isPublished();
  const std::optional<bool> rod =
      elastic_->ranOverStep() ? std::make_optional(elastic_->isBesideBlowAt(time)) : std::nullopt;
  return !result.uncertain && !isBesideBlow(*tracker_, output.crank, output.deviation.angle, rod);
}

/// Finds the stamp of the next output. Returns true if it is not after the sample.
bool WrenchSampler::isDue(StampNs sample, StampNs& stamp) const noexcept {
  stamp = sample;
  if (rate_ > 0.0) {
    const double after = static_cast<double>(index_) * 1e9 / rate_;  // [ns]
    if (!(after <= static_cast<double>(kLastStamp))) return false;   // no stamp can hold it
    stamp = origin_ + static_cast<StampNs>(std::llround(after));
  }
  return stamp <= sample;
}

/// Returns the impulse from added_up_to_ to a time: a difference of momenta, also with an elastic rod.
LoadImpulse WrenchSampler::motionTo(double time) noexcept {
  if (!elastic_->ranOverStep()) return motionImpulse(*model_, drive_, *step_, added_up_to_, time);
  const ElasticFollower::Impulse impulse = elastic_->impulse(drive_, added_up_to_, time);
  blow_deviation_ = blow_deviation_ + impulse.deviation;
  return impulse.motion;
}

void WrenchSampler::addUpTo(double time, const SampleResult& result) noexcept {
  if (!(time > added_up_to_)) return;
  const double part = (time - added_up_to_) / (step_->length() - added_up_to_);  // part of the rest of the step
  const LoadColumns there = columns_ + static_cast<float>(part) * (result.load_columns - columns_);
  column_impulse_ += static_cast<float>(0.5 * (time - added_up_to_)) * (columns_ + there);
  columns_ = there;
  const LoadImpulse motion = motionTo(time);
  const LoadImpulse added = addedImpulse(*model_, drive_, *step_, hull_, added_up_to_, time);
  impulse_ = {impulse_.all + motion.all + added.all, impulse_.drive_y + motion.drive_y + added.drive_y};
  added_up_to_ = time;
}

/// Takes the hull's motion over the step that the sample ends, and the errors at the sample that are not the crank's.
void WrenchSampler::followStep(const SampleResult& result) noexcept {
  other_covariance_before_ = other_covariance_;
  other_covariance_ = result.other_covariance;
  hull_.from = hull_.to;
  hull_.to = result.hull.motion;
  hull_.length = step_->length();
  hull_.blow.reset();
  for (const CrankStep::Passage& passage : *step_)
    if (passage.strikes) hull_.blow = passage.time;
}

WrenchOutput WrenchSampler::output(StampNs stamp, const LinksForGradient& links, const SampleResult& result) noexcept {
  ++index_;
  const bool at_sample = stamp == result.stamp;
  const double time = at_sample ? step_->length() : seconds(stamp - step_->start());
  const HullMotion hull = at_sample ? result.hull.motion : hull_.at(time);
  WrenchOutput output;
  output.stamp = stamp;
  output.crank = at_sample ? result.crank : elastic_->ranOverStep() ? elastic_->crankAt(time) : step_->at(time);
  if (kind_ == OutputKind::kMean) {
    addUpTo(time, result);
    output.interval = seconds(stamp - last_output_);
    output.wrench = (1.0 / output.interval) * impulse_.all;
    output.drive_reaction_y = impulse_.drive_y / output.interval;
    impulse_ = {};
  } else {
    if (at_sample)
      output.wrench = result.wrench;
    else
      setInstant(time, hull, output);
    output.drive_reaction_y = drive_.torque(output.crank.acceleration, hull.acceleration);
  }
  last_output_ = stamp;
  if (at_sample) {
    output.near_blow = near_blow_(links.here.links);
    output.deviation = result.deviation;
    boundMean(links, result.uncertainty.own, result, output);
    return output;
  }
  const CrankUncertainty uncertainty = tracker_->uncertaintyBetween(time, torque_part_);
  const LinksForGradient there(*model_, linksAt(*model_, output.crank.position.angle));
  output.near_blow = near_blow_(there.here.links);
  output.deviation = deviation(output.crank, uncertainty, there, hull, result);
  boundMean(there, uncertainty.own, result, output);
  return output;
}

/// Sets crank and wrench of an output between two samples.
void WrenchSampler::setInstant(double time, const HullMotion& hull, WrenchOutput& output) const noexcept {
  if (!elastic_->ranOverStep()) {
    output.wrench = hullWrench(*model_, drive_, motionOf(output.crank), hull);
    return;
  }
  const ElasticFollower::Instant instant = elastic_->at(time, drive_, hull);
  output.crank = instant.crank, output.wrench = instant.wrench;
}

HullDeviation WrenchSampler::deviation(const CrankEstimate& crank, const CrankUncertainty& uncertainty,
                                       const LinksForGradient& there, const HullMotion& hull,
                                       const SampleResult& result) const noexcept {
  LoadColumns unused;
  HullDeviation of = hullDeviation(*hammer_, *model_, step_->driveInertia(), crank, there, hull, uncertainty, unused);
  addHullMotion(*model_, drive_, there.here.links, crank.speed, hull, result.hull.covariance, of);
  // Errors by rod and unknown forces change at a blow; before it they are those of the previous sample.
  const bool before_blow = hull_.blow && crank.position.angle.side == Side::kBeforeBlow;
  of.covariance += before_blow ? other_covariance_before_ : other_covariance_;
  return of;
}

HullDeviation WrenchSampler::deviation(double time, const CrankEstimate& crank,
                                       const SampleResult& result) const noexcept {
  return deviation(crank, tracker_->uncertaintyBetween(time, torque_part_),
                   LinksForGradient(*model_, linksAt(*model_, crank.position.angle)), result.hull.motion, result);
}

/// Bounds the error of a mean. Readings enter through the momenta at both ends, a constant by the mean of its errors.
void WrenchSampler::boundMean(const LinksForGradient& links, const Eigen::Matrix3d& own, const SampleResult& result,
                              WrenchOutput& output) noexcept {
  if (kind_ != OutputKind::kMean) return;
  HullDeviation& deviation = output.deviation;
  const HullWrench modelled = elastic_->ranOverStep() ? elastic_->momentumDeviation(drive_)
                                                      : momentumDeviation(*model_, drive_, output.crank, links, own) +
                                                            wrenchOf(vectorOf(result.rod_momentum).cwiseAbs());
  const HullWrench momentum =
      modelled + wrenchOf(UnknownForce::kKeepsSign * result.unknown.rowwise().sum().cwiseSqrt());
  const Eigen::Vector3d allowed = (1.0 / output.interval) * vectorOf(momentum_std_ + momentum + blow_deviation_);
  momentum_std_ = momentum;
  blow_deviation_ = {};
  const Eigen::Vector3d of_end = (deviation.covariance - deviation.common_covariance).diagonal().cwiseMax(0.0);
  const Eigen::Vector3d common =
      (1.0 / square(output.interval)) * column_impulse_.rowwise().squaredNorm().cast<double>();
  column_impulse_.setZero();
  setVariances(common, deviation.common_covariance);
  setVariances(of_end.cwiseMin(allowed.cwiseAbs2()) + common, deviation.covariance);
}

}  // namespace hammer_loads
