/// A sample's loads as a row of numbers, in the order of channelNames(), and their means over bands of time.
#pragma once

#include <cstddef>
#include <vector>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/pipeline/sample_result.h"

namespace hammer_loads {

constexpr std::size_t kHullChannels = 3;  ///< channels at the front: force_x, force_z, torque_y

inline void wrenchValues(const HullWrench& wrench, double* values) noexcept {
  values[0] = wrench.force_x, values[1] = wrench.force_z, values[2] = wrench.torque_y;
}

/// Writes the values of all channels at an accepted sample; NaN: not known. boom: as for the names. All arrays have one
/// element per name. The wrench's standard deviations are those of extremes at the sample. common: their part due to
/// constants.
void channelValues(const SampleResult& result, const Boom* boom, double* values, double* deviations,
                   double* common) noexcept;

/// The hull's means are exact integrals of the wrench over the crank's path. The boom's are trapezoidal integrals over
/// the same intervals. No allocation after construction.
class BandMeans {
 public:
  /// bandwidth [Hz], > 0. channels: total number. Refers to the pipeline, which must outlive it.
  BandMeans(const Pipeline& pipeline, double bandwidth, std::size_t channels);

  /// Notes that the next sample does not continue the one before.
  void restart() noexcept;
  /// Takes the pipeline's last sample, which was accepted, with its values by channelValues(). Calls take(stamp,
  /// values, deviations, common) for each interval that ends by then; NaN: not known.
  template <typename Take>
  void sample(const double* values, const double* deviations, const double* common, const Take& take) noexcept {
    if (!follow(values)) return;
    for (const WrenchOutput& mean : means_) {
      form(mean, deviations, common);
      take(mean.stamp, mean_.data(), deviations_.data(), common_.data());
    }
    means_.clear();
    addUpTo(now_);
  }

 private:
  bool follow(const double* values) noexcept;
  void keep(const double* values) noexcept;
  void form(const WrenchOutput& mean, const double* deviations, const double* common) noexcept;
  void addUpTo(StampNs stamp) noexcept;

  const Pipeline* pipeline_;
  WrenchSampler sampler_;
  std::vector<WrenchOutput> means_;  ///< means of the hull since the last sample in use
  bool begun_{}, known_{};           ///< known_: the loads of the sample are published
  StampNs before_{}, now_{};         ///< the last two samples in use
  StampNs added_up_to_{};
  std::vector<double> values_before_, values_, integral_;  ///< elements of the hull are not used
  std::vector<double> mean_, deviations_, common_;
};

}  // namespace hammer_loads
