/// From slider samples to jaw edges, as messages: the same for the live node, the nodelet and process_bag.
///
/// Everything is in the grapple frame `grapple` (doc/grapple.md): x to the right jaw, y up, z towards who looks at
/// them.
#pragma once

#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hammer_loads/RunInfo.h>
#include <sensor_msgs/JointState.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/grapple/grapple_settings.h"
#include "hammer_loads/grapple/grapple_tracker.h"
#include "hammer_loads/ros/output.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Outputs of the jaw edge P.
struct JawOutputs {
  /// jaw: left or right.
  explicit JawOutputs(const std::string& jaw)
      : edge("jaw_edge/" + jaw, LoggedOutputs::kWrench),
        twist("jaw_edge/" + jaw + "_twist", LoggedOutputs::kWrench),
        accel("jaw_edge/" + jaw + "_accel", LoggedOutputs::kWrench) {}

  Output<geometry_msgs::PointStamped> edge;   ///< P [m]
  Output<geometry_msgs::TwistStamped> twist;  ///< velocity of P [m/s], turning speed of the jaw about z [rad/s]
  Output<geometry_msgs::AccelStamped> accel;  ///< acceleration of P [m/s2], turning acceleration about z [rad/s2]
};

struct GrappleOutputs {
  Output<RunInfo> run_info{"run_info", LoggedOutputs::kNone, Delivery::kLatched};
  JawOutputs left{"left"}, right{"right"};
  /// Joints of scripts/grapple_urdf [m, rad] with their speeds if the slider's is known.
  Output<sensor_msgs::JointState> mechanism{"mechanism"};

  template <typename Visit>
  void forEach(const Visit& visit) {
    visit(run_info);
    for (JawOutputs* jaw : {&left, &right}) visit(jaw->edge), visit(jaw->twist), visit(jaw->accel);
    visit(mechanism);
  }
};

/// Reason why a message gave no sample; refusals by the linkage are a SliderRefusal.
enum class MessageRefusal : std::size_t {
  kMissingJoint,  ///< the slider joint is not in the message
  kShortArray,    ///< fewer positions (or, where there are any, velocities) than names
  kOutOfOrder,    ///< older than the last accepted sample
  kDuplicate,     ///< stamp equal to that of the last accepted sample
  kCount
};

/// Samples refused for one reason.
struct RefusalCount {
  std::string reason;
  std::uint64_t count{};
  std::string last;  ///< one line: the last slider position refused and what is allowed; empty if position is not it
};

/// Owns the tracker and the outputs, whose messages are filled in place.
class GrappleFlow {
 public:
  explicit GrappleFlow(const GrappleSettings& settings);

  void jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time);
  /// Time jumped: the next sample starts cold; counts stay.
  void reset() noexcept;

  GrappleOutputs& outputs() { return outputs_; }
  const GrappleTracker& tracker() const { return tracker_; }
  const GrappleSettings& settings() const { return settings_; }

  std::uint64_t accepted() const noexcept { return tracker_.count(SliderRefusal::kNone); }
  std::uint64_t messagesWithoutJoint() const noexcept { return count(MessageRefusal::kMissingJoint); }
  /// Messages without the joint are not among them: on a shared topic they are none of the grapple's.
  std::uint64_t refused() const noexcept;
  std::uint64_t withoutVelocity() const noexcept { return without_velocity_; }  ///< accepted, no twist, no accel
  std::uint64_t withoutAcceleration() const noexcept { return without_acceleration_; }  ///< accepted, no accel
  /// Every reason, counted or not. For reports, not for the hot path.
  std::vector<RefusalCount> refusals() const;

 private:
  void beginRun(const ros::Time& record_time);
  void sendJaw(const JawMotion& motion, const ros::Time& stamp, const ros::Time& record_time, JawOutputs& outputs);
  void sendMechanism(const ros::Time& stamp, const ros::Time& record_time);
  void refuse(MessageRefusal refusal) noexcept { ++message_refusals_[static_cast<std::size_t>(refusal)]; }
  std::uint64_t count(MessageRefusal refusal) const noexcept {
    return message_refusals_[static_cast<std::size_t>(refusal)];
  }

  GrappleSettings settings_;
  GrappleTracker tracker_;
  StampOrder stamps_;
  bool has_velocity_{}, has_acceleration_{};  ///< flags of the last accepted sample
  std::array<std::uint64_t, static_cast<std::size_t>(MessageRefusal::kCount)> message_refusals_{};
  std::array<double, kSliderRefusalKinds> last_refused_{};  ///< slider position [m]
  std::uint64_t without_velocity_{}, without_acceleration_{};
  GrappleOutputs outputs_;
  bool run_begun_{};
};

}  // namespace hammer_loads
