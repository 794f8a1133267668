#include "hammer_loads/pipeline/hull_outputs.h"

#include <cmath>

#include "hammer_loads/pipeline/step_impulse.h"

namespace hammer_loads {

HullOutputs::HullOutputs(const HullModel& model, const CrankStep& step, const PipelineSettings& settings)
    : model_(&model), step_(&step), kind_(settings.output), rate_(settings.output_rate) {}

void HullOutputs::sample(StampNs stamp, const CrankEstimate& crank, const HullWrench& wrench,
                         const HullMotion& hull) noexcept {
  stamp_ = stamp;
  crank_ = crank;
  wrench_ = wrench;
  hull_ = hull;
  added_up_to_ = 0.0;
  ready_ = true;
  if (begun_) return;
  begun_ = true;
  origin_ = last_output_ = stamp;
  index_ = kind_ == OutputKind::kMean ? 1 : 0;
  impulse_ = {};
  ready_ = kind_ != OutputKind::kMean;  // no interval yet
}

/// Stamp of the next output, if it is not after the last sample.
bool HullOutputs::due(StampNs& stamp) const noexcept {
  if (rate_ > 0.0) {
    stamp = origin_ + static_cast<StampNs>(std::llround(static_cast<double>(index_) * 1e9 / rate_));
    return stamp <= stamp_;
  }
  stamp = stamp_;
  return true;
}

void HullOutputs::addUpTo(double time) noexcept {
  if (!(time > added_up_to_)) return;
  impulse_ = impulse_ + motionImpulse(*model_, *step_, added_up_to_, time) +
             addedImpulse(*model_, *step_, hull_, added_up_to_, time);
  added_up_to_ = time;
}

bool HullOutputs::next(HullOutput& output) noexcept {
  if (!ready_) return false;
  ready_ = due(output.stamp);
  if (!ready_) {
    if (kind_ == OutputKind::kMean) addUpTo(step_->length());
    return false;
  }
  ++index_;
  const bool at_sample = output.stamp == stamp_;
  const double time = at_sample ? step_->length() : kSecondsPerNs * static_cast<double>(output.stamp - step_->start());
  output.crank = at_sample ? crank_ : step_->at(time);
  output.interval = 0.0;
  if (kind_ == OutputKind::kMean) {
    addUpTo(time);
    output.interval = kSecondsPerNs * static_cast<double>(output.stamp - last_output_);
    output.wrench = (1.0 / output.interval) * impulse_;
    impulse_ = {};
  } else {
    output.wrench = at_sample ? wrench_ : hullWrench(*model_, motionOf(output.crank), hull_);
  }
  last_output_ = output.stamp;
  if (at_sample) ready_ = false;
  return true;
}

}  // namespace hammer_loads
