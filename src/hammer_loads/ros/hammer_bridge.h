/// Conversion of input messages to output messages, common to the live node, the nodelet and process_bag.
#pragma once

#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "hammer_loads/pipeline/limit_watch.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/pipeline/reference.h"
#include "hammer_loads/ros/fill_messages.h"
#include "hammer_loads/ros/frame_wrench.h"
#include "hammer_loads/ros/hammer_outputs.h"
#include "hammer_loads/ros/life_flow.h"
#include "hammer_loads/ros/reading_queue.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Bridge that owns the pipeline and the outputs. Outputs depend on inputs and settings alone. record_time: that of an
/// input, passed on to the outputs that it causes. Readings ahead of the crank wait for its samples.
class HammerBridge {
 public:
  /// pieces: receives the cycle counts of each run as well, and must outlive this object; null: none.
  explicit HammerBridge(const Settings& settings, life::PieceSink* pieces = nullptr);

  void crank(const sensor_msgs::JointState& message, const ros::Time& record_time);
  void jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time);
  void hullImu(const sensor_msgs::Imu& message, const ros::Time& record_time);
  /// Takes the gauge pressure in a chamber of one of the boom's cylinders.
  void cylinderPressure(std::size_t cylinder, Chamber chamber, const sensor_msgs::FluidPressure& message,
                        const ros::Time& record_time);
  /// Takes a measured load on the hull for comparison; it does not change any output.
  void reference(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time);
  void measured(StampNs stamp, const ReferenceComparison::Values& load) { reference_.measured(stamp, load); }
  /// Takes a message of /tf or of /tf_static. The latter do not begin a run, since they apply to every run.
  void transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time);
  /// Ends the inputs: sends the blow that is still being measured, at the record time of the last crank message.
  void end();
  /// Begins a new run with the next input, in the initial state; counters continue. It is used after jumps of time and
  /// for logs, which must be reproducible from their own inputs. Static transforms are kept.
  void reset() { begin(Settings(settings_)); }
  /// Begins a run with other settings.
  void begin(const Settings& settings);

  /// Sets the function called after each crank message and at the end of a run, before its revolutions are sent.
  void watch(std::function<void()> sample) { watch_ = std::move(sample); }
  /// Ends the count of the current run with its last ~load_cycles and piece. The next message begins a new count.
  void finishCount();
  /// Ends a run and its log: calls end() and finishCount().
  void finishRun();

  HammerOutputs& outputs() { return outputs_; }
  const HammerOutputs& outputs() const { return outputs_; }
  const Settings& settings() const { return settings_; }
  const Pipeline& pipeline() const { return *pipeline_; }
  const LifeFlow& life() const { return *life_; }
  const ReferenceComparison& comparison() const { return reference_; }
  const std::optional<LimitWatch>& limits() const { return limits_; }  ///< nothing if none are given
  const std::optional<FrameWrenches>& frameWrenches() const { return frame_wrenches_; }

 private:
  /// Link of boom_wrench that belongs to the boom's chain.
  struct ChainLink {
    int link;            ///< index in the chain
    std::size_t output;  ///< index in outputs_.boom_wrench
  };

  /// Queues of the readings that are ahead of the crank.
  struct Ahead {
    explicit Ahead(Pipeline& pipeline);

    template <typename Each>
    void forEach(const Each& each);

    ReadingQueue<sensor_msgs::JointState> joints;
    ReadingQueue<ImuReading> imu;
    std::vector<ReadingQueue<double>> pressures;  ///< bore and rod of each cylinder, in turn
  };

  void prepareOutputs();
  void beginCount();
  void beginRun(const ros::Time& record_time);
  void send(const WrenchOutput& output, const ros::Time& record_time);
  void sendBoom(const ros::Time& record_time);
  /// Sends the first sample of each hundredth of a second.
  void sendMechanism(const SampleResult& result, const ros::Time& record_time);
  void send(const TurnEnd& end, const ros::Time& record_time);

  Settings settings_;
  std::optional<Pipeline> pipeline_;    ///< replaced with each run, at the same address
  std::optional<Ahead> ahead_;          ///< replaced with each run
  std::optional<StampNs> crank_stamp_;  ///< header stamp of the last crank sample of the run
  HammerOutputs outputs_;
  std::optional<CylinderJoints> cylinder_joints_;  ///< joints of the boom's cylinders, in the mechanism's message
  std::optional<LifeFlow> life_;                   ///< load cycles of the run, replaced with each count
  life::PieceSink* pieces_;                        ///< receiver of the counts; null: none
  std::optional<LimitWatch> limits_;               ///< limits of the run
  ReferenceComparison reference_;                  ///< comparison of the run
  bool goes_on_{};                                 ///< true if the last crank sample was published
  std::vector<ChainLink> chain_links_;
  std::vector<std::size_t> frame_outputs_;  ///< indices in outputs_.boom_wrench, in the order of the frames
  std::optional<FrameWrenches> frame_wrenches_;
  std::function<void()> watch_;
  bool run_begun_{};
  ros::Time last_record_time_;         ///< record time of the last crank message
  std::int64_t mechanism_period_{-1};  ///< index of the last ~mechanism message's period, counted from the epoch
};

}  // namespace hammer_loads
