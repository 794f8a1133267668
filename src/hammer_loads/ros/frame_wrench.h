/// Load of the hull in TF frames that are no link of the boom's chain, such as the frame of a strain gauge.
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/circular_buffer.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/hammer/hull_wrench.h"

namespace hammer_loads {

/// Counters of the wrenches for a frame.
struct FrameWrenchCounts {
  std::uint64_t published{};
  std::uint64_t dropped{};  ///< no transform at their stamp: none within the wait, TF began later, or too many waited
  std::size_t waiting{};
};

/// Transforms wrenches to other frames. A wrench without a transform at its stamp waits for it in a queue of bounded
/// time and length, and is dropped if none arrives. Single-threaded and non-blocking: each input may release waiting
/// wrenches, which then have the record time of that input.
class FrameWrenches {
 public:
  using Publish =
      std::function<void(std::size_t frame, const ros::Time& stamp, const Wrench& load, const ros::Time& record_time)>;

  /// hull: frame of the wrenches. max_wait: longest record time between a wrench and the input that releases it [s].
  FrameWrenches(std::vector<std::string> frames, std::string hull, double max_wait, Publish publish);

  /// Takes a message of /tf or /tf_static. A transform that tf2 cannot hold (not finite, beyond 1e6 m, no rotation, no
  /// name, a stamp near the end of time) is ignored.
  void transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time);
  /// Takes a load on the hull about its origin, in axes of the hull. Stamps must increase.
  void wrench(const ros::Time& stamp, const HullWrench& load, const ros::Time& record_time);
  /// Resets after a jump of time: discards waiting wrenches and all transforms but the static ones.
  void reset();

  const std::vector<std::string>& frames() const { return frames_; }
  FrameWrenchCounts counts(std::size_t frame) const;
  /// Returns why the last dropped wrench of a frame was not published, in one line; empty if one was published since.
  std::string complaint(std::size_t frame) const;

 private:
  struct Pending {
    ros::Time stamp, arrival;
    HullWrench load;
  };
  static constexpr std::size_t kMostPending = 4096;  ///< four seconds at 1 kHz
  struct Queue {
    boost::circular_buffer<Pending> pending{kMostPending};  ///< oldest first
    FrameWrenchCounts counts;
    ros::Time unknown;  ///< stamp of the last wrench dropped; zero if one was published since

    void dropOldest();
  };

  template <typename Action>
  void guarded(const Action& action);
  bool known(std::size_t frame, const ros::Time& stamp) const;
  bool past(std::size_t frame, const ros::Time& stamp) const;
  void release(std::size_t frame, const ros::Time& record_time);

  std::vector<std::string> frames_;
  std::string hull_;
  double max_wait_;  ///< [s]
  Publish publish_;
  tf2::BufferCore transforms_;
  std::vector<Queue> queues_;
};

}  // namespace hammer_loads
