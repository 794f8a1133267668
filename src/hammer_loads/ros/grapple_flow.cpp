#include "hammer_loads/ros/grapple_flow.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/ros/stamp.h"

namespace hammer_loads {
namespace {

constexpr char kGrappleFrame[] = "grapple";
constexpr std::array<const char*, static_cast<std::size_t>(MessageRefusal::kCount)> kMessageRefusalNames{
    "missing joint", "short array", "out of order", "duplicate"};
/// Joints of each jaw in the order of publishMechanism.
constexpr std::array<const char*, 6> kLinks{"drive_rod", "rocker", "lever", "jaw", "tie_rod", "main_rocker"};

double betweenPis(double angle) { return std::remainder(angle, kTwoPi); }

}  // namespace

GrappleFlow::GrappleFlow(const GrappleSettings& settings, GrappleSink& sink)
    : settings_(settings), sink_(sink), tracker_(settings.grapple), stamps_(settings.stale_after) {
  run_info_.version = HAMMER_LOADS_VERSION;
  run_info_.revision = HAMMER_LOADS_REVISION;
  run_info_.parameters_yaml = settings.yaml;
  for (JawMessages& jaw : jaws_) {
    for (std_msgs::Header* header : {&jaw.edge.header, &jaw.twist.header, &jaw.accel.header})
      header->frame_id = kGrappleFrame;
  }
  mechanism_.header.frame_id = kGrappleFrame;
  mechanism_.name = {settings.slider_joint};
  for (const char* side : {"left", "right"}) {
    for (const char* link : kLinks) mechanism_.name.push_back(std::string("grapple_") + side + "_" + link + "_joint");
  }
  mechanism_.position.resize(mechanism_.name.size());
  mechanism_.velocity.reserve(mechanism_.name.size());
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
  run_info_.header.stamp = record_time;
  sink_.runInfo(run_info_, record_time);
}

void GrappleFlow::jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  beginRun(record_time);
  const std::optional<Reading> reading = read(message);
  if (!reading) return;
  const std::optional<StampOrder::Verdict> verdict = order(message.header.stamp);
  if (!verdict) return;
  const std::optional<double> slider_acceleration = acceleration(*reading, *verdict);
  if (!track(*reading, slider_acceleration)) return;
  stamps_.accept(stampOf(message.header.stamp));
  has_velocity_ = reading->velocity.has_value();
  has_acceleration_ = slider_acceleration.has_value();
  without_velocity_ += !has_velocity_;
  without_acceleration_ += !has_acceleration_;
  for (const Jaw jaw : kJaws) {
    if (sink_.wants(jaw)) publishJaw(jaw, message.header.stamp, record_time);
  }
  if (sink_.wantsMechanism()) publishMechanism(message.header.stamp, record_time);
}

std::optional<GrappleFlow::Reading> GrappleFlow::read(const sensor_msgs::JointState& message) noexcept {
  const auto found = std::find(message.name.begin(), message.name.end(), settings_.slider_joint);
  if (found == message.name.end()) {
    refuse(MessageRefusal::kMissingJoint);
    return std::nullopt;
  }
  const auto i = static_cast<std::size_t>(found - message.name.begin());
  if (i >= message.position.size() || (!message.velocity.empty() && i >= message.velocity.size())) {
    refuse(MessageRefusal::kShortArray);
    return std::nullopt;
  }
  if (message.velocity.empty()) return Reading{message.position[i], std::nullopt};
  return Reading{message.position[i], message.velocity[i]};
}

std::optional<StampOrder::Verdict> GrappleFlow::order(const ros::Time& stamp) noexcept {
  const StampOrder::Verdict verdict = stamps_.judge(stampOf(stamp));
  if (verdict.place == StampOrder::Place::kDuplicate) {
    refuse(MessageRefusal::kDuplicate);
    return std::nullopt;
  }
  if (verdict.place == StampOrder::Place::kOutOfOrder) {
    refuse(MessageRefusal::kOutOfOrder);
    return std::nullopt;
  }
  return verdict;
}

/// Of the slider [m/s2]; nothing where it is not known.
std::optional<double> GrappleFlow::acceleration(const Reading& reading,
                                                const StampOrder::Verdict& verdict) const noexcept {
  if (!reading.velocity) return std::nullopt;
  if (settings_.acceleration == SliderAcceleration::kNone) return 0.0;
  if (verdict.place != StampOrder::Place::kNext || !has_velocity_) return std::nullopt;
  return (*reading.velocity - tracker_.slider().velocity) / verdict.step;
}

bool GrappleFlow::track(const Reading& reading, std::optional<double> acceleration) noexcept {
  const SliderRefusal refusal =
      tracker_.update({reading.position, reading.velocity.value_or(0.0), acceleration.value_or(0.0)});
  if (refusal == SliderRefusal::kNone) return true;
  last_refused_[static_cast<std::size_t>(refusal)] = reading.position;
  return false;
}

void GrappleFlow::publishJaw(Jaw jaw, const ros::Time& stamp, const ros::Time& record_time) {
  JawMessages& m = jaws_[static_cast<std::size_t>(jaw)];
  const JawMotion motion = jaw == Jaw::kLeft ? tracker_.left() : tracker_.right();
  m.edge.header.stamp = stamp;
  m.edge.point.x = motion.edge.re;
  m.edge.point.y = motion.edge.im;
  sink_.edge(jaw, m.edge, record_time);
  if (!has_velocity_) return;
  m.twist.header.stamp = stamp;
  m.twist.twist.linear.x = motion.edge_velocity.re;
  m.twist.twist.linear.y = motion.edge_velocity.im;
  m.twist.twist.angular.z = motion.turning_speed;
  sink_.twist(jaw, m.twist, record_time);
  if (!has_acceleration_) return;
  m.accel.header.stamp = stamp;
  m.accel.accel.linear.x = motion.edge_acceleration.re;
  m.accel.accel.linear.y = motion.edge_acceleration.im;
  m.accel.accel.angular.z = motion.turning_acceleration;
  sink_.accel(jaw, m.accel, record_time);
}

/// Each joint turns a link against the one that carries it. The left jaw's linkage is the right one turned by half a
/// turn about y, so its joints have the same positions.
void GrappleFlow::publishMechanism(const ros::Time& stamp, const ros::Time& record_time) {
  const auto [rocker, lever, jaw, tie_rod, main_rocker, drive_rod] =
      tracker_.grapple().linkDirections(tracker_.motion());
  const auto against = [](const LinkDirection& link, const LinkDirection& carrier) -> LinkDirection {
    return {betweenPis(link.angle - carrier.angle), link.d - carrier.d};
  };
  const std::array<LinkDirection, kLinks.size()> joints{
      drive_rod, rocker, against(lever, rocker), against(jaw, lever), against(tie_rod, lever), main_rocker};
  const SliderMotion& slider = tracker_.slider();
  mechanism_.header.stamp = stamp;
  mechanism_.velocity.resize(has_velocity_ ? mechanism_.name.size() : 0);
  mechanism_.position[0] = slider.position;
  for (std::size_t i = 1; i < mechanism_.name.size(); ++i)
    mechanism_.position[i] = joints[(i - 1) % joints.size()].angle;
  if (has_velocity_) {
    mechanism_.velocity[0] = slider.velocity;
    for (std::size_t i = 1; i < mechanism_.name.size(); ++i)
      mechanism_.velocity[i] = joints[(i - 1) % joints.size()].d * slider.velocity;
  }
  sink_.mechanism(mechanism_, record_time);
}

std::uint64_t GrappleFlow::refused() const noexcept {
  std::uint64_t sum = tracker_.refused();
  for (const std::uint64_t count : message_refusals_) sum += count;
  return sum - messagesWithoutJoint();
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
