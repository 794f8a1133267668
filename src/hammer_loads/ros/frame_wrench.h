/// The hull's load at TF frames that are no link of the boom's chain, such as that of a strain gauge.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hammer_loads {

/// Counters of the wrenches for a frame.
struct FrameWrenchCounts {
  std::uint64_t published{};
  std::uint64_t dropped{};  ///< no transform at their stamp: none within the wait, or TF began later
  std::uint64_t crowded{};  ///< dropped because too many waited
  std::size_t waiting{};
};

/// Transforms wrenches to other frames. A wrench without a transform at its stamp waits for it in a queue of bounded
/// time and length, and is dropped if none arrives. Single-threaded and non-blocking: each input may release waiting
/// wrenches, which then have the record time of that input.
class FrameWrenches {
 public:
  using Publish =
      std::function<void(std::size_t frame, const geometry_msgs::WrenchStamped&, const ros::Time& record_time)>;

  /// hull: the wrenches' frame. max_wait: between record times of a wrench and of what releases it [s].
  FrameWrenches(std::vector<std::string> frames, std::string hull, double max_wait, Publish publish);

  /// A message of /tf, or of /tf_static. A transform that tf2 cannot hold (not finite, beyond 1e6 m, no rotation, no
  /// name, a stamp near the end of time) is ignored and counted.
  void transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time);
  /// A load on the hull about its origin, axes of the hull; stamps grow.
  void wrench(const geometry_msgs::WrenchStamped& load, const ros::Time& record_time);
  /// Resets after a jump of time: discards waiting wrenches and all transforms but the static ones.
  void reset();

  const std::vector<std::string>& frames() const { return frames_; }
  FrameWrenchCounts counts(std::size_t frame) const;
  std::uint64_t refusedTransforms() const { return refused_transforms_; }
  /// Reason why the last dropped wrench of a frame was not published, in one line; empty if one was published since.
  std::string complaint(std::size_t frame) const;

 private:
  struct Pending {
    ros::Time stamp, arrival;
    geometry_msgs::Wrench load;
  };
  static constexpr std::size_t kMostPending = 4096;  ///< four seconds at 1 kHz
  /// A ring of pending wrenches, oldest first.
  struct Queue {
    std::vector<Pending> ring = std::vector<Pending>(kMostPending);
    std::size_t first{}, size{};
    FrameWrenchCounts counts;
    ros::Time unknown;  ///< stamp of the last wrench dropped; zero if one was published since

    const Pending& front() const { return ring[first]; }
    void pop() { first = (first + 1) % kMostPending, --size; }
    void push(const Pending& pending);
    void drop(std::uint64_t& count);
  };

  template <typename Action>
  void guarded(const Action& action);
  bool known(std::size_t frame, const ros::Time& stamp) const;
  bool past(std::size_t frame, const ros::Time& stamp) const;
  void release(std::size_t frame, const ros::Time& record_time);
  void publish(std::size_t frame, const Pending& pending, const ros::Time& record_time);

  std::vector<std::string> frames_;
  std::string hull_;
  double max_wait_;  ///< [s]
  Publish publish_;
  tf2::BufferCore transforms_;
  std::uint64_t refused_transforms_{};
  std::vector<Queue> queues_;
  std::vector<geometry_msgs::WrenchStamped> messages_;
};

}  // namespace hammer_loads
