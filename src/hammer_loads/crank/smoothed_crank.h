/// A recording's crank by earlier and later samples.
#pragma once

#include <memory>

#include "hammer_loads/crank/crank_track.h"
#include "hammer_loads/crank/estimate_between.h"

namespace hammer_loads {

/// Gives the samples of a track again, in their order. It must be asked as the tracker was that filled the track; each
/// start() or update() needs a sample that is ready. What a sample is taken for (a restart, an outlier, doubtful) is
/// what the filter took it for.
class SmoothedCrank final : public CrankTracker {
 public:
  /// now: a filter as the track's began.
  SmoothedCrank(const ShaftModel& model, CrankFilter now, std::shared_ptr<CrankTrack> track);

  void start(const CrankSample& sample) noexcept override;
  Tracking update(double dt, const CrankSample& sample) noexcept override;
  void setHullMotion(const HullMotion& hull) noexcept override;

  CrankEstimate estimate() const noexcept override;
  CrankEstimate between(double dt) const noexcept override;
  std::optional<CrankWays> waysBetween(double dt) const noexcept override;
  bool hasSpeed() const noexcept override { return now_.has_speed; }
  bool isPlausible() const noexcept override { return now_.is_plausible; }
  CrankUncertainty uncertaintyBetween(double dt, double torque_part) const noexcept override;
  CrankUncertainty uncertainty(double torque_part) const noexcept override;
  BlowFactor blowFactor() const noexcept override;
  double driveInertia() const noexcept override { return now_.belief.state.drive_inertia; }
  double struckInertia() const noexcept override { return now_.belief.struckInertia(model_); }
  bool isDoubtful() const noexcept override { return now_.is_doubtful; }
  bool readingShowsSide() const noexcept override { return now_.reading_shows_side; }
  bool isProven() const noexcept override { return now_.is_proven; }
  double consistency() const noexcept override { return now_.consistency; }
  double strikeConsistency() const noexcept override { return now_.strike_consistency; }
  /// As it is after the last sample that came into the track.
  const CrankFilter* filter() const noexcept override { return &track_->filter(); }
  const CrankFilter* filterNow() const noexcept override { return &live_; }
  void setInterval(double interval) noexcept override { live_.setInterval(interval); }
  void considerLatency(double deviation) noexcept override { live_.considerLatency(deviation); }
  void considerRod(double angle, double speed) noexcept override;
  double lostTime() const noexcept override { return now_.lost_time; }
  int slips() const noexcept override { return now_.slips; }
  double angleResolution() const noexcept override { return now_.resolution; }

 private:
  Tracking next() noexcept;
  BetweenSamples lastStep() const noexcept;
  CrankUncertainty uncertaintyOf(const CrankBelief& belief, double torque_part) const noexcept;

  std::shared_ptr<CrankTrack> track_;
  CrankFilter live_;
  ShaftModel model_;       ///< with the latest motion of the hull
  ShaftModel step_model_;  ///< with its mean over the step
  HullMotion before_hull_, now_hull_;
  CrankBelief before_;
  TrackedSample now_;
};

}  // namespace hammer_loads
