/// Interface of the live nodes for programs and nodelets, which thus do not include the headers of the node.
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

namespace hammer_loads {

/// A node that works from its construction to its destruction.
class LiveNode {
 public:
  virtual ~LiveNode() = default;
};

/// Makes the hammer's node from its private parameters. Returns null after problems, which are reported one a line.
std::unique_ptr<LiveNode> makeHammerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                         std::vector<std::string>& problems);

}  // namespace hammer_loads
