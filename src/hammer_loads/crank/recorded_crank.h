/// The filter, with every sample written to a track.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "hammer_loads/crank/crank_track.h"

namespace hammer_loads {

/// Estimates are the filter's, bit for bit. For recordings: the track grows by each sample, which allocates. Closes the
/// track at its end.
class RecordedCrank final : public CrankTracker {
 public:
  explicit RecordedCrank(std::shared_ptr<CrankTrack> track) : track_(std::move(track)), filter_(track_->filter()) {}
  ~RecordedCrank() override { track_->close(); }
  RecordedCrank(const RecordedCrank&) = delete;
  RecordedCrank& operator=(const RecordedCrank&) = delete;

  void start(const CrankSample& sample) noexcept override { track_->start(sample); }
  Tracking update(double dt, const CrankSample& sample) noexcept override { return track_->update(dt, sample); }
  void setHullMotion(const HullMotion& hull) noexcept override { track_->setHullMotion(hull); }

  void setInterval(double interval) noexcept override { track_->filter().setInterval(interval); }
  double lostTime() const noexcept override { return filter_.lostTime(); }
  int slips() const noexcept override { return filter_.slips(); }
  void considerRod(double angle, double speed) noexcept override { track_->considerRod(angle, speed); }
  void considerLatency(double deviation) noexcept override { track_->filter().considerLatency(deviation); }

  CrankEstimate estimate() const noexcept override { return filter_.estimate(); }
  CrankEstimate between(double dt) const noexcept override { return filter_.between(dt); }
  std::optional<CrankWays> waysBetween(double dt) const noexcept override { return filter_.waysBetween(dt); }
  bool hasSpeed() const noexcept override { return filter_.hasSpeed(); }
  bool isPlausible() const noexcept override { return filter_.isPlausible(); }
  CrankUncertainty uncertaintyBetween(double dt, double torque_part) const noexcept override {
    return filter_.uncertaintyBetween(dt, torque_part);
  }
  CrankUncertainty uncertainty(double torque_part) const noexcept override { return filter_.uncertainty(torque_part); }
  BlowFactor blowFactor() const noexcept override { return filter_.blowFactor(); }
  double driveInertia() const noexcept override { return filter_.driveInertia(); }
  double struckInertia() const noexcept override { return filter_.struckInertia(); }
  bool isDoubtful() const noexcept override { return filter_.isDoubtful(); }
  double otherBranch() const noexcept override { return filter_.otherBranch(); }
  bool readingShowsSide() const noexcept override { return filter_.readingShowsSide(); }
  bool isProven() const noexcept override { return filter_.isProven(); }
  double consistency() const noexcept override { return filter_.consistency(); }
  double strikeConsistency() const noexcept override { return filter_.strikeConsistency(); }
  const CrankFilter* filter() const noexcept override { return &filter_; }
  double angleResolution() const noexcept override { return filter_.angleResolution(); }

 private:
  std::shared_ptr<CrankTrack> track_;
  const CrankFilter& filter_;
};

}  // namespace hammer_loads
