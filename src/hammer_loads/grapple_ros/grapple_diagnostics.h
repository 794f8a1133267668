/// The grapple node's own health on /diagnostics.
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <cstdint>

#include "hammer_loads/grapple_ros/grapple_flow.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/ros/diagnostics_publisher.h"

namespace hammer_loads {

/// Published at `~diagnostic_period` (1 s) of wall time: rate, age, counts of accepted and refused samples by reason,
/// with the slider positions that are allowed, log health.
class GrappleDiagnostics {
 public:
  GrappleDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleFlow& flow, BagLog& log,
                     const RecordClock& clock);

  /// An input arrived that has the slider joint; its age decides whether the slider is stale.
  void sliderArrived() { last_slider_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;

  void describeSlider(diagnostic_updater::DiagnosticStatusWrapper& status);
  void summarise(Clock::time_point now, diagnostic_updater::DiagnosticStatusWrapper& status) const;

  const GrappleFlow& flow_;
  Clock::time_point last_slider_{}, last_report_{Clock::now()};
  std::uint64_t last_accepted_{}, last_refused_{}, last_without_velocity_{};
  DiagnosticsPublisher publisher_;
  ros::WallTimer timer_;
};

}  // namespace hammer_loads
