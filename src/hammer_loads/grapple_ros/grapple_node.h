/// The live grapple as programs and nodelets see it.
#pragma once

#include "hammer_loads/ros/live_node.h"

namespace hammer_loads {

/// Counterpart of makeHammerNode.
std::unique_ptr<LiveNode> makeGrappleNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems);

}  // namespace hammer_loads
