/// From input messages to output messages: the same for the live node, the nodelet and process_bag.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/HullLoads.h>
#include <hammer_loads/PinForces.h>
#include <hammer_loads/Pulse.h>
#include <hammer_loads/RunInfo.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <optional>
#include <string>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/ros/boom_messages.h"
#include "hammer_loads/ros/frame_wrench.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Where output messages go. record_time: that of the input that caused the message.
class LoadsSink {
 public:
  virtual ~LoadsSink() = default;
  virtual void runInfo(const RunInfo& message, const ros::Time& record_time) = 0;
  virtual void hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) = 0;
  virtual void boomWrench(const std::string& link, const geometry_msgs::WrenchStamped& message,
                          const ros::Time& record_time) = 0;
  virtual void jointLoads(const JointLoads& message, const ros::Time& record_time) = 0;
  virtual void boomVibration(const BoomVibration& message, const ros::Time& record_time) = 0;
  virtual void hullLoads(const HullLoads& message, const ros::Time& record_time) = 0;
  virtual void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) = 0;
  virtual void pinForces(const PinForces& message, const ros::Time& record_time) = 0;
  virtual void blow(const Blow& message, const ros::Time& record_time) = 0;
  virtual void pulse(const Pulse& message, const ros::Time& record_time) = 0;
  /// What nobody takes is not computed.
  virtual bool wantsBoomWrench(const std::string& link) const = 0;
  virtual bool wantsJointLoads() const = 0;
  virtual bool wantsBoomVibration() const = 0;
  virtual bool wantsHullLoads() const = 0;
  virtual bool wantsMechanism() const = 0;
  virtual bool wantsPinForces() const = 0;
  virtual bool wantsTurns() const = 0;
};

/// Owns the pipeline and the messages, which are filled in place.
class LoadsFlow {
 public:
  LoadsFlow(const Settings& settings, LoadsSink& sink);

  void crank(const sensor_msgs::JointState& message, const ros::Time& record_time);
  void jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time);
  void hullImu(const sensor_msgs::Imu& message, const ros::Time& record_time);
  /// A message of /tf, or of /tf_static. The latter begin no run: they are the same in every run.
  void transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time);
  bool needsImu() const { return settings_.pipeline.hull_motion == HullMotionSource::kImu; }
  /// Whether some boom_wrench link is a TF frame: then transforms() is needed.
  bool needsTransforms() const { return frame_wrenches_.has_value(); }
  /// A run begins anew with the next input, in the state of a flow just made; counts go on. For a time that jumped and
  /// for a log that is to be reproduced from its own inputs. Static transforms stay.
  void reset() { begin(Settings(settings_)); }
  /// The same with other settings.
  void begin(const Settings& settings);

  const Settings& settings() const { return settings_; }
  const Pipeline& pipeline() const { return *pipeline_; }
  const RunInfo& runInfoMessage() const { return run_info_; }
  const std::optional<FrameWrenches>& frameWrenches() const { return frame_wrenches_; }

 private:
  void beginRun(const ros::Time& record_time);
  void publishOutput(const HullOutput& output, const ros::Time& record_time);
  void publishHullLoads(const HullOutput& output, const ros::Time& record_time);
  void publishBoom(const ros::Time& record_time);
  bool wantsAny(const std::vector<std::string>& links) const;
  bool wantsBoom() const;
  void publishTurnEnd(const TurnEnd& end, const ros::Time& record_time);
  void publishMechanism(const Loads& loads, const ros::Time& record_time);
  void publishPinForces(const Loads& loads, const ros::Time& record_time);

  Settings settings_;
  std::optional<Pipeline> pipeline_;  ///< made anew with each run, in its place
  LoadsSink& sink_;
  RunInfo run_info_;
  geometry_msgs::WrenchStamped wrench_;
  HullLoads hull_loads_;
  sensor_msgs::JointState mechanism_;
  PinForces pin_forces_;
  Blow blow_;
  Pulse pulse_;
  std::optional<BoomMessages> boom_messages_;
  std::optional<FrameWrenches> frame_wrenches_;
  bool run_begun_{};
};

}  // namespace hammer_loads
