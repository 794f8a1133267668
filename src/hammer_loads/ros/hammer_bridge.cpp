#include "hammer_loads/ros/hammer_bridge.h"

#include <algorithm>

#include "hammer_loads/ros/fill_messages.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/ros/version.h"

namespace hammer_loads {
namespace {

constexpr std::int64_t kMechanismPeriod =
    10'000'000;  // for display: robot_state_publisher sends 50 poses per second [ns]

/// Returns the frame of the hull: the tip of the boom's chain, or hull_frame without a boom.
std::string hullFrame(const Settings& settings) {
  return settings.boom ? settings.boom->parameters().chain.tip : settings.pipeline.hull_frame;
}

}  // namespace

HammerBridge::Ahead::Ahead(Pipeline& pipeline)
    : joints([&pipeline](StampNs stamp, const sensor_msgs::JointState& m) {
        pipeline.boomJoints(stamp, m.name, m.position, m.velocity);
      }),
      imu([&pipeline](StampNs stamp, const ImuReading& reading) { pipeline.hullImu(stamp, reading); }) {
  const std::size_t cylinders = pipeline.boom() ? pipeline.boom()->boom().cylinders().size() : 0;
  for (std::size_t i = 0; i < cylinders; ++i)
    for (const Chamber chamber : {Chamber::kBore, Chamber::kRod})
      pressures.emplace_back([&pipeline, i, chamber](StampNs stamp, double pressure) {
        pipeline.cylinderPressure(stamp, i, chamber, pressure);
      });
}

template <typename Each>
void HammerBridge::Ahead::forEach(const Each& each) {
  each(joints), each(imu);
  for (ReadingQueue<double>& pressure : pressures) each(pressure);
}

HammerBridge::HammerBridge(const Settings& settings, life::PieceSink* pieces) : settings_(settings), pieces_(pieces) {
  prepareOutputs();
  std::vector<std::string> frames;
  for (const std::size_t output : frame_outputs_) frames.push_back(settings.pipeline.boom_wrench_links[output]);
  if (!frames.empty()) {
    frame_wrenches_.emplace(
        frames, hullFrame(settings), settings.pipeline.tf_max_wait,
        [this](std::size_t frame, const ros::Time& stamp, const Wrench& load, const ros::Time& time) {
          outputs_.boom_wrench[frame_outputs_[frame]].send(
              time, [&](geometry_msgs::WrenchStamped& m) { fillWrench(stampOf(stamp), load, m); });
        });
  }
  reset();
}

/// Fills the constant parts of every message.
void HammerBridge::prepareOutputs() {
  const std::string frame = hullFrame(settings_);
  for (std_msgs::Header* header :
       {&outputs_.hull_wrench.message.header, &outputs_.hull_loads.message.header, &outputs_.mechanism.message.header,
        &outputs_.pin_forces.message.header, &outputs_.blow.message.header, &outputs_.pulse.message.header,
        &outputs_.turn_loads.message.header, &outputs_.alarms.message.header, &outputs_.load_cycles.message.header})
    header->frame_id = frame;
  outputs_.run_info.message.version = packageVersion();
  outputs_.run_info.message.revision = packageRevision();
  prepareMechanism(settings_.pipeline.crank_joint, outputs_.mechanism.message);
  if (settings_.boom) {
    cylinder_joints_.emplace(*settings_.boom, outputs_.mechanism.message);
    prepareJointLoads(*settings_.boom, outputs_.joint_loads.message);
    prepareSections(*settings_.boom, outputs_.section_loads.message);
    prepareReactions(*settings_.boom, outputs_.joint_reactions.message);
    prepareVibration(*settings_.boom, outputs_.boom_vibration.message);
  }
  for (const std::string& link : settings_.pipeline.boom_wrench_links) {
    const std::size_t index = outputs_.boom_wrench.size();
    const auto of_chain = settings_.boom ? settings_.boom->chain().linkIndex(link) : std::nullopt;
    if (of_chain) chain_links_.push_back({*of_chain, index});
    if (!of_chain) frame_outputs_.push_back(index);
    outputs_.boom_wrench.emplace_back("boom_wrench/" + link).message.header.frame_id = link;
  }
}

void HammerBridge::begin(const Settings& settings) {
  if (pipeline_) finishRun();
  settings_ = settings;
  const SampleCounts counts = pipeline_ ? pipeline_->counts() : SampleCounts{};
  pipeline_.emplace(settings_.mechanism, settings_.pipeline, settings_.boom, counts);
  beginCount();
  ahead_.emplace(*pipeline_);
  crank_stamp_.reset();
  reference_ = {};
  goes_on_ = false;
  mechanism_period_ = -1;
  limits_.reset();
  if (!settings_.limits.empty())
    limits_.emplace(settings_.limits, life_->machine().channels, pipeline_->counts().misuse);
  if (frame_wrenches_) frame_wrenches_->reset();
  RunInfo& run_info = outputs_.run_info.message;
  run_info.parameters_yaml = settings_.yaml;
  run_info.robot_description = settings_.robot_description;
  run_info.notes = settings_.notes;
  run_begun_ = false;
}

void HammerBridge::beginCount() { life_.emplace(*pipeline_, settings_, outputs_, pieces_); }

void HammerBridge::finishCount() {
  if (!life_->begun()) return;
  life_->finish();
  beginCount();
}

void HammerBridge::finishRun() {
  end();
  finishCount();
}

/// Sends run_info with the stamp of the first input, so that processing the same input again gives the same message.
void HammerBridge::beginRun(const ros::Time& record_time) {
  if (run_begun_) return;
  run_begun_ = true;
  outputs_.run_info.message.header.stamp = record_time;
  outputs_.run_info.send(record_time);
}

void HammerBridge::hullImu(const sensor_msgs::Imu& message, const ros::Time& record_time) {
  beginRun(record_time);
  const geometry_msgs::Vector3 &a = message.linear_acceleration, &w = message.angular_velocity;
  ahead_->imu.add(stampOf(message.header.stamp), {{a.x, a.y, a.z}, {w.x, w.y, w.z}}, crank_stamp_);
}

void HammerBridge::cylinderPressure(std::size_t cylinder, Chamber chamber, const sensor_msgs::FluidPressure& message,
                                    const ros::Time& record_time) {
  beginRun(record_time);
  const std::size_t queue = 2 * cylinder + static_cast<std::size_t>(chamber);
  ahead_->pressures[queue].add(stampOf(message.header.stamp), message.fluid_pressure, crank_stamp_);
}

void HammerBridge::reference(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) {
  beginRun(record_time);
  const geometry_msgs::Wrench& w = message.wrench;
  measured(stampOf(message.header.stamp), {w.force.x, w.force.z, w.torque.y});
}

void HammerBridge::transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time) {
  if (!frame_wrenches_) return;
  if (!is_static) beginRun(record_time);
  frame_wrenches_->transforms(message, is_static, record_time);
}

void HammerBridge::jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  beginRun(record_time);
  ahead_->joints.add(stampOf(message.header.stamp), message, crank_stamp_);
}

void HammerBridge::crank(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  beginRun(record_time);
  const StampNs stamp = stampOf(message.header.stamp);
  if (std::find(message.name.begin(), message.name.end(), settings_.pipeline.crank_joint) != message.name.end())
    crank_stamp_ = stamp;
  if (crank_stamp_) ahead_->forEach([this](auto& queue) { queue.passUpTo(*crank_stamp_); });
  const SampleResult& result = pipeline_->crankJoint(stamp, message.name, message.position, message.velocity);
  life_->follow(message, record_time);
  if (watch_) watch_();
  last_record_time_ = record_time;
  const bool continues = std::exchange(goes_on_, result.isPublished()) && pipeline_->crank().step().known() &&
                         !pipeline_->crank().step().strikes();
  if (result.isPublished()) reference_.computed(result.stamp, result.wrench, result.deviation.wrench(), continues);
  for (std::size_t i = 0; i < result.turn_ends; ++i) send(result.ends[i], record_time);
  if (result.refusal) return;
  for (const WrenchOutput& output : result.outputs) send(output, record_time);
  if (!result.isPublished()) return;
  if (result.boom != nullptr && !result.boom->fault) sendBoom(record_time);
  sendMechanism(result, record_time);
  outputs_.pin_forces.send(record_time, [&](PinForces& m) { fillPinForces(result, m); });
}

void HammerBridge::sendMechanism(const SampleResult& result, const ros::Time& record_time) {
  const std::int64_t period = result.stamp / kMechanismPeriod;
  if (std::exchange(mechanism_period_, period) == period) return;
  outputs_.mechanism.send(record_time, [&](sensor_msgs::JointState& m) {
    fillMechanism(result, m);
    if (cylinder_joints_ && result.boom != nullptr) cylinder_joints_->fill(pipeline_->boom()->boom(), m);
  });
}

void HammerBridge::end() {
  ahead_->forEach([](auto& queue) { queue.passAll(); });
  const SampleResult& result = pipeline_->end();
  life_->end();
  if (watch_) watch_();
  for (std::size_t i = 0; i < result.turn_ends; ++i) send(result.ends[i], last_record_time_);
}

void HammerBridge::send(const WrenchOutput& output, const ros::Time& record_time) {
  outputs_.hull_wrench.send(record_time,
                            [&](geometry_msgs::WrenchStamped& m) { fillWrench(output.stamp, output.wrench, m); });
  outputs_.hull_loads.send(record_time, [&](HullLoads& m) { fillHullLoads(pipeline_->result(), output, m); });
  const bool frames = std::any_of(frame_outputs_.begin(), frame_outputs_.end(),
                                  [&](std::size_t i) { return outputs_.boom_wrench[i].isWanted(); });
  if (frames) frame_wrenches_->wrench(timeOf(output.stamp), output.wrench, record_time);
  if (!pipeline_->boom() || !pipeline_->boom()->known()) return;
  for (const ChainLink& link : chain_links_) {
    outputs_.boom_wrench[link.output].send(record_time, [&](geometry_msgs::WrenchStamped& m) {
      fillWrench(output.stamp, pipeline_->boom()->wrenchAtLink(link.link, output.wrench), m);
    });
  }
}

void HammerBridge::sendBoom(const ros::Time& record_time) {
  const BoomFollower& boom = *pipeline_->boom();
  if (!boom.state().useless) {
    outputs_.joint_loads.send(record_time, [&](JointLoads& m) { fillJointLoads(boom.state(), m); });
    if (!boom.boom().sections().empty())
      outputs_.section_loads.send(record_time, [&](SectionLoads& m) { fillSections(boom.state(), m); });
    outputs_.joint_reactions.send(record_time, [&](JointReactions& m) { fillReactions(boom.state(), m); });
  }
  outputs_.boom_vibration.send(record_time, [&](BoomVibration& m) { fillVibration(boom, m); });
}

void HammerBridge::send(const TurnEnd& end, const ros::Time& record_time) {
  outputs_.blow.send(record_time, [&](Blow& m) { fillBlow(end, m); });
  life_->sendTurn(end, record_time);
  if (limits_ && limits_->judge(end, pipeline_->counts().misuse, life_->follower().total()))
    outputs_.alarms.send(record_time, [&](Alarms& m) { fillAlarms(end, *limits_, m); });
  if (end.pulse) outputs_.pulse.send(record_time, [&](Pulse& m) { fillPulse(end, m); });
}

}  // namespace hammer_loads
