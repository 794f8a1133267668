#include "hammer_loads/grapple_ros/grapple_flow.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/ros/version.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr char kGrappleFrame[] = "grapple";
constexpr std::array<const char*, static_cast<std::size_t>(MessageRefusal::kCount)> kMessageRefusalNames{
    "missing joint", "short array", "out of order", "duplicate"};
/// Joints of each jaw in the order of sendMechanism.
constexpr std::array<const char*, 6> kLinks{"drive_rod", "rocker", "lever", "jaw", "tie_rod", "main_rocker"};

}  // namespace

GrappleFlow::GrappleFlow(const GrappleSettings& settings)
    : settings_(settings), tracker_(settings.grapple), stamps_(settings.stale_after) {
  RunInfo& run_info = outputs_.run_info.message;
  run_info.version = packageVersion();
  run_info.revision = packageRevision();
  run_info.parameters_yaml = settings.yaml;
  for (JawOutputs* jaw : {&outputs_.left, &outputs_.right}) {
    for (std_msgs::Header* header : {&jaw->edge.message.header, &jaw->twist.message.header, &jaw->accel.message.header})
      header->frame_id = kGrappleFrame;
  }
  sensor_msgs::JointState& mechanism = outputs_.mechanism.message;
  mechanism.header.frame_id = kGrappleFrame;
  mechanism.name = {settings.slider_joint};
  for (const char* side : {"left", "right"}) {
    for (const char* link : kLinks) mechanism.name.push_back(std::string("grapple_") + side + "_" + link + "_joint");
  }
  mechanism.position.resize(mechanism.name.size());
  mechanism.velocity.reserve(mechanism.name.size());
}

void GrappleFlow::reset() noexcept {
  tracker_.reset();
  stamps_.reset();
  run_begun_ = false;
}

/// Stamped with the first input: a second run over the same input says the same.
void GrappleFlow::beginRun(const ros::Time& record_time) {
  if (run_begun_) return;
  run_begun_ = true;
  outputs_.run_info.message.header.stamp = record_time;
  outputs_.run_info.send(record_time);
}

void GrappleFlow::jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  using Place = StampOrder::Place;
  beginRun(record_time);
  const auto found = std::find(message.name.begin(), message.name.end(), settings_.slider_joint);
  if (found == message.name.end()) return refuse(MessageRefusal::kMissingJoint);
  const auto i = static_cast<std::size_t>(found - message.name.begin());
  const bool has_velocity = !message.velocity.empty();
  if (i >= message.position.size() || (has_velocity && i >= message.velocity.size()))
    return refuse(MessageRefusal::kShortArray);
  const StampOrder::Verdict verdict = stamps_.judge(stampOf(message.header.stamp));
  if (verdict.place == Place::kDuplicate) return refuse(MessageRefusal::kDuplicate);
  if (verdict.place == Place::kOutOfOrder) return refuse(MessageRefusal::kOutOfOrder);

  SliderMotion slider{message.position[i], has_velocity ? message.velocity[i] : 0.0, 0.0};
  const bool has_step = verdict.place == Place::kNext && has_velocity_;
  const bool has_acceleration = has_velocity && (settings_.acceleration == SliderAcceleration::kNone || has_step);
  if (has_acceleration && settings_.acceleration == SliderAcceleration::kDifference)
    slider.acceleration = (slider.velocity - tracker_.slider().velocity) / verdict.step;
  if (const SliderRefusal refusal = tracker_.update(slider); refusal != SliderRefusal::kNone) {
    last_refused_[static_cast<std::size_t>(refusal)] = slider.position;
    return;
  }
  stamps_.accept(stampOf(message.header.stamp));
  has_velocity_ = has_velocity;
  has_acceleration_ = has_acceleration;
  without_velocity_ += !has_velocity_;
  without_acceleration_ += !has_acceleration_;
  sendJaw(tracker_.left(), message.header.stamp, record_time, outputs_.left);
  sendJaw(tracker_.right(), message.header.stamp, record_time, outputs_.right);
  sendMechanism(message.header.stamp, record_time);
}

void GrappleFlow::sendJaw(const JawMotion& motion, const ros::Time& stamp, const ros::Time& record_time,
                          JawOutputs& outputs) {
  geometry_msgs::PointStamped& edge = outputs.edge.message;
  edge.header.stamp = stamp;
  edge.point.x = motion.edge.re;
  edge.point.y = motion.edge.im;
  outputs.edge.send(record_time);
  if (!has_velocity_) return;
  geometry_msgs::TwistStamped& twist = outputs.twist.message;
  twist.header.stamp = stamp;
  twist.twist.linear.x = motion.edge_velocity.re;
  twist.twist.linear.y = motion.edge_velocity.im;
  twist.twist.angular.z = motion.turning_speed;
  outputs.twist.send(record_time);
  if (!has_acceleration_) return;
  geometry_msgs::AccelStamped& accel = outputs.accel.message;
  accel.header.stamp = stamp;
  accel.accel.linear.x = motion.edge_acceleration.re;
  accel.accel.linear.y = motion.edge_acceleration.im;
  accel.accel.angular.z = motion.turning_acceleration;
  outputs.accel.send(record_time);
}

/// Each joint turns a link against the one that carries it. The left jaw's linkage is the right one turned by half a
/// turn about y, so its joints have the same positions.
void GrappleFlow::sendMechanism(const ros::Time& stamp, const ros::Time& record_time) {
  const auto [rocker, lever, jaw, tie_rod, main_rocker, drive_rod] =
      tracker_.grapple().linkDirections(tracker_.motion());
  const auto against = [](const LinkDirection& link, const LinkDirection& carrier) -> LinkDirection {
    return {std::remainder(link.angle - carrier.angle, kTwoPi), link.d - carrier.d};
  };
  const std::array<LinkDirection, kLinks.size()> joints{
      drive_rod, rocker, against(lever, rocker), against(jaw, lever), against(tie_rod, lever), main_rocker};
  const SliderMotion& slider = tracker_.slider();
  sensor_msgs::JointState& message = outputs_.mechanism.message;
  message.header.stamp = stamp;
  message.velocity.resize(has_velocity_ ? message.name.size() : 0);
  message.position[0] = slider.position;
  for (std::size_t i = 1; i < message.name.size(); ++i) message.position[i] = joints[(i - 1) % joints.size()].angle;
  if (has_velocity_) {
    message.velocity[0] = slider.velocity;
    for (std::size_t i = 1; i < message.name.size(); ++i)
      message.velocity[i] = joints[(i - 1) % joints.size()].d * slider.velocity;
  }
  outputs_.mechanism.send(record_time);
}

std::uint64_t GrappleFlow::refused() const noexcept {
  const auto messages = std::accumulate(message_refusals_.begin(), message_refusals_.end(), std::uint64_t{0});
  return tracker_.refused() + messages - messagesWithoutJoint();
}

std::vector<RefusalCount> GrappleFlow::refusals() const {
  std::vector<RefusalCount> all;
  for (std::size_t i = 0; i < message_refusals_.size(); ++i)
    all.push_back({kMessageRefusalNames[i], message_refusals_[i], {}});
  for (std::size_t i = 1; i < last_refused_.size(); ++i) {
    const auto refusal = static_cast<SliderRefusal>(i);
    const std::uint64_t count = tracker_.count(refusal);
    std::string last;
    if (count > 0 && refusal != SliderRefusal::kNotFinite)
      last = tracker_.grapple().explain(refusal, last_refused_[i], settings_.slider_joint);
    all.push_back({nameOf(refusal), count, last});
  }
  return all;
}

}  // namespace hammer_loads
