#include "hammer_loads/ros/frame_wrench.h"

#include <utility>

#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

Eigen::Vector3d vector(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

geometry_msgs::Vector3 message(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 m;
  m.x = v.x(), m.y = v.y(), m.z = v.z();
  return m;
}

Pose pose(const geometry_msgs::Transform& transform) {
  const geometry_msgs::Quaternion& q = transform.rotation;
  // TF takes quaternions whose length is wrong by 1e-6.
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  return Eigen::Translation3d(vector(transform.translation)) * rotation;
}

}  // namespace

void FrameWrenches::Queue::push(const Pending& pending) {
  if (size == kMostPending) drop(counts.crowded);
  ring[(first + size) % kMostPending] = pending;
  ++size;
}

void FrameWrenches::Queue::drop(std::uint64_t& count) {
  unknown = front().stamp;
  ++count;
  pop();
}

FrameWrenches::FrameWrenches(std::vector<std::string> frames, std::string hull, double max_wait, Tell tell)
    : frames_(std::move(frames)),
      hull_(std::move(hull)),
      max_wait_(max_wait),
      tell_(std::move(tell)),
      queues_(frames_.size()),
      messages_(frames_.size()) {
  for (std::size_t i = 0; i < frames_.size(); ++i) messages_[i].header.frame_id = frames_[i];
}

void FrameWrenches::transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms)
    transforms_.setTransform(transform, "tf", is_static);
  for (std::size_t i = 0; i < frames_.size(); ++i) release(i, record_time);
}

void FrameWrenches::wrench(const geometry_msgs::WrenchStamped& load, const ros::Time& record_time) {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    queues_[i].push({load.header.stamp, record_time, load.wrench});
    release(i, record_time);
  }
}

void FrameWrenches::reset() {
  transforms_.clear();
  for (Queue& queue : queues_) queue.first = queue.size = 0;
}

bool FrameWrenches::known(std::size_t frame, const ros::Time& stamp) const {
  return transforms_.canTransform(frames_[frame], hull_, stamp);
}

/// TF is connected and has gone beyond that time: no later transform will be of use for it.
bool FrameWrenches::past(std::size_t frame, const ros::Time& stamp) const {
  return known(frame, ros::Time()) &&
         transforms_.lookupTransform(frames_[frame], hull_, ros::Time()).header.stamp >= stamp;
}

void FrameWrenches::release(std::size_t frame, const ros::Time& record_time) {
  Queue& queue = queues_[frame];
  while (queue.size > 0) {
    const Pending& oldest = queue.front();
    if (known(frame, oldest.stamp)) {
      tell(frame, oldest, record_time);
      queue.pop();
    } else if (record_time - oldest.arrival > max_wait_ || past(frame, oldest.stamp)) {
      queue.drop(queue.counts.dropped);
    } else {
      return;  // nor can the younger ones be known
    }
  }
}

void FrameWrenches::tell(std::size_t frame, const Pending& pending, const ros::Time& record_time) {
  const Pose X_QH = pose(transforms_.lookupTransform(frames_[frame], hull_, pending.stamp).transform);
  const Wrench w = shifted(X_QH, {vector(pending.load.force), vector(pending.load.torque)});
  geometry_msgs::WrenchStamped& told = messages_[frame];
  told.header.stamp = pending.stamp;
  told.wrench.force = message(w.force);
  told.wrench.torque = message(w.torque);
  tell_(frame, told, record_time);
  ++queues_[frame].counts.told;
  queues_[frame].unknown = ros::Time();
}

FrameWrenchCounts FrameWrenches::counts(std::size_t frame) const {
  FrameWrenchCounts counts = queues_[frame].counts;
  counts.waiting = queues_[frame].size;
  return counts;
}

std::string FrameWrenches::complaint(std::size_t frame) const {
  const Queue& queue = queues_[frame];
  if (queue.unknown.isZero()) return {};
  std::string why;
  const bool late = transforms_.canTransform(frames_[frame], hull_, queue.unknown, &why);
  return frames_[frame] + ": no transform from " + hull_ + format(" within %.3g s", max_wait_.toSec()) +
         (late || why.empty() ? "" : ": " + onOneLine(why));
}

}  // namespace hammer_loads
