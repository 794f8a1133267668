#include "hammer_loads/ros/frame_wrench.h"

#include <cmath>
#include <limits>
#include <utility>

#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

Pose pose(const geometry_msgs::Transform& transform) {
  const geometry_msgs::Vector3& p = transform.translation;
  const geometry_msgs::Quaternion& q = transform.rotation;
  // TF accepts quaternions whose norm differs slightly from 1.
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  return Eigen::Translation3d(p.x, p.y, p.z) * rotation;
}

/// Checks a transform's bounds: tf2 adds ten seconds to stamps, multiplies chained transforms, and throws on overflow.
bool isSound(const geometry_msgs::TransformStamped& transform) {
  constexpr std::uint32_t kLatest = std::numeric_limits<std::uint32_t>::max() - 3600;  // [s]
  constexpr double kFurthest = 1e6;                                                    // [m]
  const geometry_msgs::Vector3& t = transform.transform.translation;
  const geometry_msgs::Quaternion& q = transform.transform.rotation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return transform.header.stamp.sec < kLatest && std::abs(t.x) < kFurthest && std::abs(t.y) < kFurthest &&
         std::abs(t.z) < kFurthest && std::abs(norm - 1.0) < 1e-2 && !transform.header.frame_id.empty() &&
         !transform.child_frame_id.empty();
}

}  // namespace

void FrameWrenches::Queue::dropOldest() {
  unknown = pending.front().stamp;
  ++counts.dropped;
  pending.pop_front();
}

FrameWrenches::FrameWrenches(std::vector<std::string> frames, std::string hull, double max_wait, Publish publish)
    : frames_(std::move(frames)),
      hull_(std::move(hull)),
      max_wait_(max_wait),
      publish_(std::move(publish)),
      queues_(frames_.size()) {}

void FrameWrenches::transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms)
    if (isSound(transform)) guarded([&] { transforms_.setTransform(transform, "tf", is_static); });
  for (std::size_t i = 0; i < frames_.size(); ++i) guarded([&] { release(i, record_time); });
}

/// Carries out an action and resets after an exception: tf2 throws if stamps differ by more than 2^31 s.
template <typename Action>
void FrameWrenches::guarded(const Action& action) {
  try {
    action();
  } catch (const std::exception&) {
    reset();
  }
}

void FrameWrenches::wrench(const ros::Time& stamp, const HullWrench& load, const ros::Time& record_time) {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    Queue& queue = queues_[i];
    if (queue.pending.full()) queue.dropOldest();
    queue.pending.push_back({stamp, record_time, load});
    guarded([&] { release(i, record_time); });
  }
}

void FrameWrenches::reset() {
  transforms_.clear();
  for (Queue& queue : queues_) queue.pending.clear();
}

bool FrameWrenches::known(std::size_t frame, const ros::Time& stamp) const {
  return transforms_.canTransform(frames_[frame], hull_, stamp);
}

/// Returns true if TF is connected and later than the stamp, so that no further transform can serve it.
bool FrameWrenches::past(std::size_t frame, const ros::Time& stamp) const {
  return known(frame, ros::Time()) &&
         transforms_.lookupTransform(frames_[frame], hull_, ros::Time()).header.stamp >= stamp;
}

void FrameWrenches::release(std::size_t frame, const ros::Time& record_time) {
  Queue& queue = queues_[frame];
  while (!queue.pending.empty()) {
    const Pending& oldest = queue.pending.front();
    if (known(frame, oldest.stamp)) {
      const Pose X_QH = pose(transforms_.lookupTransform(frames_[frame], hull_, oldest.stamp).transform);
      const HullWrench& load = oldest.load;
      publish_(frame, oldest.stamp, shifted(X_QH, {{load.force_x, 0.0, load.force_z}, {0.0, load.torque_y, 0.0}}),
               record_time);
      ++queue.counts.published;
      queue.unknown = ros::Time();
      queue.pending.pop_front();
    } else if (record_time.toSec() - oldest.arrival.toSec() > max_wait_ || past(frame, oldest.stamp)) {
      queue.dropOldest();
    } else {
      return;  // later ones have no transform either
    }
  }
}

FrameWrenchCounts FrameWrenches::counts(std::size_t frame) const {
  FrameWrenchCounts counts = queues_[frame].counts;
  counts.waiting = queues_[frame].pending.size();
  return counts;
}

std::string FrameWrenches::complaint(std::size_t frame) const {
  const Queue& queue = queues_[frame];
  if (queue.unknown.isZero()) return {};
  std::string why;
  bool late = false;
  try {
    late = transforms_.canTransform(frames_[frame], hull_, queue.unknown, &why);
  } catch (const std::exception& error) {
    why = error.what();
  }
  return frames_[frame] + ": no transform from " + hull_ + format(" within %.3g s", max_wait_) +
         (late || why.empty() ? "" : ": " + onOneLine(why));
}

}  // namespace hammer_loads
