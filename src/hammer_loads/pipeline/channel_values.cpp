#include "hammer_loads/pipeline/channel_values.h"

#include <algorithm>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kSectionChannels =
    decltype(Wrench::force)::SizeAtCompileTime + decltype(Wrench::torque)::SizeAtCompileTime;

double* put(const Wrench& wrench, double* place) noexcept {
  place = std::copy_n(wrench.force.data(), 3, place);
  return std::copy_n(wrench.torque.data(), 3, place);
}

}  // namespace

void channelValues(const SampleResult& result, const Boom* boom, double* values, double* deviations,
                   double* common) noexcept {
  wrenchValues(result.wrench, values);
  wrenchValues(result.ofExtreme().deviation, deviations);
  wrenchValues(result.deviation.common(), common);
  if (boom == nullptr) return;
  double* value = values + kHullChannels;
  const auto joints = static_cast<std::size_t>(boom->chain().joints());
  const std::size_t cylinders = boom->cylinders().size(), sections = boom->sections().size();
  if (result.boom == nullptr || result.boom->fault || result.boom->useless) {
    for (double* all : {values, deviations, common})
      std::fill_n(all + kHullChannels, joints + cylinders + kSectionChannels * sections, kNaN);
    return;
  }
  const BoomState& state = *result.boom;
  value = std::copy_n(state.loads.total.data(), joints, value);
  for (std::size_t i = 0; i < cylinders; ++i) *value++ = state.loads.cylinder[i].force;
  for (std::size_t i = 0; i < sections; ++i) value = put(state.steel.section[i], value);
  const auto putDeviations = [&](const BoomDeviations& of, double* place) {
    place = std::copy_n(of.torque.data(), joints, place);
    place = std::copy_n(of.cylinder.data(), cylinders, place);
    for (std::size_t i = 0; i < sections; ++i) place = put(of.section[i], place);
  };
  putDeviations(state.deviations, deviations + kHullChannels);
  putDeviations(state.common, common + kHullChannels);
}

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

/// Returns false where the means wait for the next sample. Close to a blow the boom's loads are unknown and are
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

/// Keeps the values of the sample. Unpublished loads are unknown.
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

/// Forms means; their standard deviation is that at the sample, as errors do not average out within half a period.
void BandMeans::form(const WrenchOutput& mean, const double* deviations, const double* common) noexcept {
  addUpTo(mean.stamp);
  for (std::size_t i = 0; i < mean_.size(); ++i) mean_[i] = integral_[i] / mean.interval;
  std::fill(integral_.begin(), integral_.end(), 0.0);
  std::copy_n(deviations, deviations_.size(), deviations_.begin());
  std::copy_n(common, common_.size(), common_.begin());
  wrenchValues(mean.wrench, mean_.data());
  wrenchValues(mean.deviation.wrench(), deviations_.data());
  wrenchValues(mean.deviation.common(), common_.data());
  if (!known_) std::fill_n(mean_.begin(), kHullChannels, kNaN);
}

}  // namespace hammer_loads
