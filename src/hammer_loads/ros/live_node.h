/// Interface of the live nodes for programs and nodelets, which saves them the headers of the node.
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

/// The hammer's node from its private parameters; every problem is reported on one line each and gives no node.
std::unique_ptr<LiveNode> makeHammerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                         std::vector<std::string>& problems);

}  // namespace hammer_loads
