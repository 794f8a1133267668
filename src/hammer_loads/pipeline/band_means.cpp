#include "hammer_loads/pipeline/band_means.h"

#include <algorithm>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

BandMeans::BandMeans(const Pipeline& pipeline, double bandwidth, std::size_t channels)
    : pipeline_(&pipeline),
      sampler_(pipeline.meansAt(2.0 * bandwidth)),
      values_before_(channels, kNaN),
      values_(channels, kNaN),
      integral_(channels),
      mean_(channels),
      deviations_(channels),
      common_(channels) {
  means_.reserve(3 * sampler_.mostOutputs());
}

void BandMeans::restart() noexcept {
  sampler_.forget();
  means_.clear();
  begun_ = false;
}

/// Returns false where the means wait for the next sample: close to a blow the boom's loads are not known, and are
/// interpolated.
bool BandMeans::follow(const double* values) noexcept {
  const SampleResult& result = pipeline_->result();
  pipeline_->sample(sampler_, means_);
  known_ = result.isPublished();
  if (!begun_) {
    begun_ = true;
    before_ = now_ = added_up_to_ = result.stamp;
    std::fill(integral_.begin(), integral_.end(), 0.0);
    keep(values);
    return false;
  }
  if (!known_ && result.beside_blow && 3 * means_.size() < 2 * means_.capacity()) return false;
  before_ = now_;
  now_ = result.stamp;
  values_before_.swap(values_);
  keep(values);
  return true;
}

/// Loads that are not published are not known.
void BandMeans::keep(const double* values) noexcept {
  std::copy_n(values, values_.size(), values_.begin());
  if (!known_) std::fill(values_.begin(), values_.end(), kNaN);
}

void BandMeans::addUpTo(StampNs stamp) noexcept {
  const double step = seconds(now_ - before_), length = seconds(stamp - added_up_to_);
  if (!(step > 0.0) || !(length > 0.0)) return;
  const double middle = (0.5 * length + seconds(added_up_to_ - before_)) / step;
  for (std::size_t i = kHullChannels; i < values_.size(); ++i)
    integral_[i] += length * (values_before_[i] + middle * (values_[i] - values_before_[i]));
  added_up_to_ = stamp;
}

/// The standard deviation is that at the sample, since errors do not average out within half a period.
void BandMeans::form(const WrenchOutput& mean, const double* deviations, const double* common) noexcept {
  addUpTo(mean.stamp);
  for (std::size_t i = 0; i < mean_.size(); ++i) mean_[i] = integral_[i] / mean.interval;
  std::fill(integral_.begin(), integral_.end(), 0.0);
  std::copy_n(deviations, deviations_.size(), deviations_.begin());
  std::copy_n(common, common_.size(), common_.begin());
  wrenchValues(mean.wrench, mean_.data());
  wrenchValues(mean.deviation.wrench, deviations_.data());
  wrenchValues(mean.deviation.common, common_.data());
  if (!known_) std::fill_n(mean_.begin(), kHullChannels, kNaN);
}

}  // namespace hammer_loads
