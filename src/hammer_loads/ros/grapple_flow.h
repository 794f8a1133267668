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
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/grapple/grapple_tracker.h"
#include "hammer_loads/pipeline/stamp_order.h"
#include "hammer_loads/settings/grapple_settings.h"

namespace hammer_loads {

enum class Jaw : std::size_t { kLeft, kRight };
inline constexpr std::array<Jaw, 2> kJaws{Jaw::kLeft, Jaw::kRight};

/// Names of topics, `JAW` left or right, are those of the node's private outputs.
/// record_time: that of the input that caused the message.
class GrappleSink {
 public:
  virtual ~GrappleSink() = default;
  virtual void runInfo(const RunInfo& message, const ros::Time& record_time) = 0;
  /// `jaw_edge/JAW`: P [m].
  virtual void edge(Jaw jaw, const geometry_msgs::PointStamped& message, const ros::Time& record_time) = 0;
  /// `jaw_edge/JAW_twist`: velocity of P [m/s], turning speed of the jaw about z [rad/s].
  virtual void twist(Jaw jaw, const geometry_msgs::TwistStamped& message, const ros::Time& record_time) = 0;
  /// `jaw_edge/JAW_accel`: acceleration of P [m/s2], turning acceleration of the jaw about z [rad/s2].
  virtual void accel(Jaw jaw, const geometry_msgs::AccelStamped& message, const ros::Time& record_time) = 0;
  /// `mechanism`: joints of scripts/grapple_urdf [m, rad] with their speeds if the slider's is known.
  virtual void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) = 0;
  /// What nobody takes is not computed.
  virtual bool wants(Jaw jaw) const = 0;
  virtual bool wantsMechanism() const = 0;
};

/// Why a message gave no sample; what the linkage refuses is a SliderRefusal.
enum class MessageRefusal : std::size_t {
  kMissingJoint,  ///< the slider joint is not in the message
  kShortArray,    ///< fewer positions (or, where there are any, velocities) than names
  kOutOfOrder,    ///< older than the last accepted sample
  kDuplicate,     ///< as old as the last accepted sample
  kCount
};

/// Samples refused for one reason.
struct RefusalCount {
  std::string reason;
  std::uint64_t count{};
  std::string last;  ///< one line: the last slider position refused and what is allowed; empty if position is not it
};

/// Owns the tracker and the messages, which are filled in place.
class GrappleFlow {
 public:
  GrappleFlow(const GrappleSettings& settings, GrappleSink& sink);

  void jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time);
  /// Time jumped: the next sample starts cold; counts stay.
  void reset() noexcept;

  const GrappleTracker& tracker() const { return tracker_; }
  const GrappleSettings& settings() const { return settings_; }
  const RunInfo& runInfoMessage() const { return run_info_; }

  std::uint64_t accepted() const noexcept { return tracker_.count(SliderRefusal::kNone); }
  std::uint64_t messagesWithoutJoint() const noexcept { return count(MessageRefusal::kMissingJoint); }
  /// Messages without the joint are not among them: on a shared topic they are none of the grapple's.
  std::uint64_t refused() const noexcept;
  std::uint64_t withoutVelocity() const noexcept { return without_velocity_; }  ///< accepted, no twist, no accel
  std::uint64_t withoutAcceleration() const noexcept { return without_acceleration_; }  ///< accepted, no accel
  /// Every reason, counted or not. For reports, not for the hot path.
  std::vector<RefusalCount> refusals() const;

 private:
  struct Reading {
    double position{};               ///< [m]
    std::optional<double> velocity;  ///< [m/s]
  };
  struct JawMessages {
    geometry_msgs::PointStamped edge;
    geometry_msgs::TwistStamped twist;
    geometry_msgs::AccelStamped accel;
  };

  void beginRun(const ros::Time& record_time);
  std::optional<Reading> read(const sensor_msgs::JointState& message) noexcept;
  std::optional<StampOrder::Verdict> order(const ros::Time& stamp) noexcept;
  std::optional<double> acceleration(const Reading& reading, const StampOrder::Verdict& verdict) const noexcept;
  bool track(const Reading& reading, std::optional<double> acceleration) noexcept;
  void publishJaw(Jaw jaw, const ros::Time& stamp, const ros::Time& record_time);
  void publishMechanism(const ros::Time& stamp, const ros::Time& record_time);
  void refuse(MessageRefusal refusal) noexcept { ++message_refusals_[static_cast<std::size_t>(refusal)]; }
  std::uint64_t count(MessageRefusal refusal) const noexcept {
    return message_refusals_[static_cast<std::size_t>(refusal)];
  }

  GrappleSettings settings_;
  GrappleSink& sink_;
  GrappleTracker tracker_;
  StampOrder stamps_;
  bool has_velocity_{}, has_acceleration_{};  ///< of the last accepted sample
  std::array<std::uint64_t, static_cast<std::size_t>(MessageRefusal::kCount)> message_refusals_{};
  std::array<double, kSliderRefusalKinds> last_refused_{};  ///< slider position [m]
  std::uint64_t without_velocity_{}, without_acceleration_{};
  RunInfo run_info_;
  std::array<JawMessages, kJaws.size()> jaws_;
  sensor_msgs::JointState mechanism_;
  bool run_begun_{};
};

}  // namespace hammer_loads
