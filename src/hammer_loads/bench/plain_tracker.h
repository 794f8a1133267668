/// Crank motion without a model of the mechanism, for comparison: what the papers assume and what a difference gives.
#pragma once

#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/pipeline/make_tracker.h"

namespace hammer_loads::accuracy {

/// Angle and speed as measured (speed by difference of angles where none is measured); acceleration zero, as P0
/// assumes, or by difference of speeds. Neglects noise, encoder counts and the mechanism; how wrong the peak
/// force of a working machine is: doc/accuracy.md, clean sessions.
class PlainTracker final : public CrankTracker {
 public:
  enum class Acceleration { kZero, kDifference };

  /// angle_resolution: one count [rad]; drive_inertia: as given [kg m2].
  PlainTracker(Acceleration acceleration, double angle_resolution, double drive_inertia, const CrankSensor& sensor)
      : acceleration_(acceleration), drive_inertia_(drive_inertia), encoder_(angle_resolution, sensor) {}

  void start(const CrankSample& sample) noexcept override;
  Tracking update(double dt, const CrankSample& sample) noexcept override;
  CrankEstimate estimate() const noexcept override { return now_; }
  /// Angle by the cubic through both angles and speeds, speed and acceleration linear.
  CrankEstimate between(double dt) const noexcept override;
  bool hasSpeed() const noexcept override { return has_speed_; }
  double angleResolution() const noexcept override { return encoder_.resolution(); }
  double driveInertia() const noexcept override { return drive_inertia_; }

 private:
  CrankSample ofCrank(const CrankSample& reading) noexcept;

  Acceleration acceleration_;
  double drive_inertia_;
  Encoder encoder_;
  CrankEstimate now_;
  CrankEstimate before_;
  double step_{};
  bool has_speed_{};
};

/// For a pipeline, in place of the filter.
TrackerMaker plainTracker(PlainTracker::Acceleration acceleration);

}  // namespace hammer_loads::accuracy
