#include "hammer_loads/pipeline/joint_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr double kLeastJump = 0.1, kFastest = 3.0;  // [rad, m], [rad/s, m/s]: three times as fast as a boom's joints
// Limit: kLeastJump, kFastest

}  // namespace

double JointBuffer::Track::difference(double from, double to) const noexcept {
  return turns_freely ? std::remainder(to - from, kTwoPi) : to - from;
}

JointBuffer::JointBuffer(const Chain& chain, const PipelineSettings& settings, const JointVector& zeros)
    : names_(chain.jointNames()),
      zeros_(names_.size()),
      tracks_(names_.size()),
      max_age_(settings.joint_max_age),
      differentiate_(settings.boom_acceleration == BoomAcceleration::kDifference) {
  std::copy(zeros.data(), zeros.data() + zeros.size(), zeros_.begin());
  for (int j = 0; j < chain.joints(); ++j) {
    const bool revolute = !chain.link(chain.linkBeyond(j)).prismatic;
    tracks_[static_cast<std::size_t>(j)].turns_freely = revolute && std::isinf(chain.upper()[j]);
  }
}

bool JointBuffer::update(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                         const std::vector<double>& velocities) noexcept {
  bool taken = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::find(names_.begin(), names_.end(), names[i]);
    if (found == names_.end()) continue;
    if (i >= positions.size()) {
      ++refusals_.short_array;
      continue;
    }
    std::optional<double> velocity;
    if (i < velocities.size()) velocity = velocities[i];
    if (!velocity && !velocities.empty()) ++refusals_.short_array;
    if (!std::isfinite(positions[i]) || !std::isfinite(velocity.value_or(0.0))) ++refusals_.not_finite;
    if (!std::isfinite(positions[i])) continue;
    if (velocity && !std::isfinite(*velocity)) velocity.reset();
    const auto joint = static_cast<std::size_t>(found - names_.begin());
    const double position = positions[i] - zeros_[joint];
    Track& track = tracks_[joint];
    if (!isInOrder(track, stamp) || jumps(track, stamp, position)) continue;
    add(track, stamp, position, velocity);
    taken = true;
  }
  return taken;
}

bool JointBuffer::isInOrder(Track& track, StampNs stamp) noexcept {
  if (track.count == 0 || stamp > track.back(0).stamp) {
    track.rewound.reset();
    return true;
  }
  const bool again = track.rewound && stamp > *track.rewound;
  if (stamp < track.back(0).stamp) track.rewound = stamp;
  if (!again) {
    ++refusals_.out_of_order;
    return false;
  }
  track.rewound.reset();
  track.count = 0;
  return true;
}

/// Returns true for a single jump, which is a damaged state.
bool JointBuffer::jumps(Track& track, StampNs stamp, double position) noexcept {
  const bool second = track.jumped;
  track.jumped = false;
  if (track.count == 0 || second) return false;
  const State& last = track.back(0);
  const double way = std::abs(track.difference(last.position, position));
  track.jumped = way > kLeastJump + kFastest * seconds(stamp - last.stamp);
  refusals_.jumps += track.jumped;
  return track.jumped;
}

void JointBuffer::add(Track& track, StampNs stamp, double position, std::optional<double> velocity) noexcept {
  State next{stamp, position, velocity.value_or(0.0), 0.0, 0.0};
  if (track.count > 0) {
    const State& last = track.back(0);
    const double step = seconds(stamp - last.stamp);
    if (cameTogether(last.stamp, stamp)) return replace(track, next, velocity.has_value());
    if (!velocity) {
      next.velocity = track.difference(last.position, position) / step;
      next.velocity_age = 0.5 * step;
    }
    // The first velocity from a difference has no predecessor.
    const bool known = velocity || track.count > 1;
    if (known) next.acceleration = (next.velocity - last.velocity) / (step - next.velocity_age + last.velocity_age);
  }
  track.states[track.count % kKept] = next;
  ++track.count;
}

/// Replaces the last state by one that came with it; over so short a time, velocity and acceleration cannot be
/// determined.
void JointBuffer::replace(Track& track, State next, bool has_velocity) noexcept {
  State& last = track.states[(track.count - 1) % kKept];
  if (!has_velocity) next.velocity = last.velocity, next.velocity_age = last.velocity_age;
  next.acceleration = last.acceleration;
  last = next;
}

JointBuffer::Bracket JointBuffer::around(const Track& track, StampNs stamp) noexcept {
  const std::uint64_t kept = std::min(track.count, kKept);
  const State* after = nullptr;
  for (std::uint64_t i = 0; i < kept; ++i) {
    const State& state = track.back(i);
    if (state.stamp <= stamp) {
      const double age = seconds(stamp - state.stamp);
      return {&state, after, after == nullptr ? age : std::min(age, seconds(after->stamp - stamp))};
    }
    after = &state;
  }
  if (after == nullptr) return {nullptr, nullptr, std::numeric_limits<double>::infinity()};
  return {after, nullptr, seconds(after->stamp - stamp)};
}

std::optional<JointFault> JointBuffer::fault(int joint, const Bracket& bracket) const noexcept {
  if (bracket.before == nullptr) return JointFault{JointFault::Kind::kMissing, joint, bracket.age};
  if (bracket.age > max_age_) return JointFault{JointFault::Kind::kStale, joint, bracket.age};
  return std::nullopt;
}

std::optional<JointFault> JointBuffer::at(StampNs stamp, JointMotion& motion) const noexcept {
  const auto joints = static_cast<Eigen::Index>(tracks_.size());
  motion.position.resize(joints), motion.velocity.resize(joints), motion.acceleration.resize(joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const Track& track = tracks_[static_cast<std::size_t>(j)];
    const Bracket bracket = around(track, stamp);
    if (auto found = fault(static_cast<int>(j), bracket)) return found;
    const State& before = *bracket.before;
    const State& newest = bracket.after != nullptr ? *bracket.after : before;
    motion.position[j] = before.position;
    motion.velocity[j] = newest.velocity;
    motion.acceleration[j] = differentiate_ ? newest.acceleration : 0.0;
    if (bracket.after == nullptr) continue;
    const double part = seconds(stamp - before.stamp) / seconds(newest.stamp - before.stamp);
    motion.position[j] += part * track.difference(before.position, newest.position);
    if (newest.velocity_age == 0.0) motion.velocity[j] += (1.0 - part) * (before.velocity - newest.velocity);
  }
  return std::nullopt;
}

std::optional<JointBuffer::Reading> JointBuffer::newest(int joint) const noexcept {
  const Track& track = tracks_[static_cast<std::size_t>(joint)];
  if (track.count == 0) return std::nullopt;
  return Reading{track.back(0).stamp, track.back(0).position};
}

std::vector<std::string> JointBuffer::complaints(StampNs stamp) const {
  std::vector<std::string> lines;
  for (std::size_t j = 0; j < tracks_.size(); ++j) {
    const auto found = fault(static_cast<int>(j), around(tracks_[j], stamp));
    if (!found) continue;
    lines.push_back(names_[j] + (found->kind == JointFault::Kind::kMissing
                                     ? ": never heard"
                                     : format(": %.3g s old, must be at most %.3g s", found->age, max_age_)));
  }
  return lines;
}

}  // namespace hammer_loads
