/// The boom's state as messages, which are filled in place.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/BoomVibration.h>
#include <hammer_loads/JointLoads.h>

#include <string>
#include <vector>

#include "hammer_loads/pipeline/boom_follower.h"

namespace hammer_loads {

/// Those of the wrench links that are no link of the boom's chain (all of them without a boom): TF frames.
std::vector<std::string> framesBesideChain(const std::vector<std::string>& wrench_links, const Boom* boom);

/// Of a follower's last sample, which must have no fault. Names are filled once; nothing is allocated per sample. Each
/// result is valid until its next call.
class BoomMessages {
 public:
  /// The follower must outlive this.
  BoomMessages(const BoomFollower& follower, const std::vector<std::string>& wrench_links);

  const JointLoads& jointLoads();
  const BoomVibration& vibration();
  /// Links of the chain among the wrench links, in their order.
  const std::vector<std::string>& links() const { return links_; }
  /// A load on the hull about D [N, N m] at one of links(), axes and frame of that link; the pose is that of the
  /// follower's last sample.
  const geometry_msgs::WrenchStamped& wrench(std::size_t link, const ros::Time& stamp, const HullWrench& load);

 private:
  const BoomFollower& follower_;
  JointLoads joint_loads_;
  BoomVibration vibration_;
  std::vector<std::string> links_;
  std::vector<int> indices_;  ///< of links_ in the chain
  std::vector<geometry_msgs::WrenchStamped> wrenches_;
};

}  // namespace hammer_loads
