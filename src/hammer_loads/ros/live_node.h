/// The live nodes as programs and nodelets see them: without the headers that a node is made of, seconds for each.
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

namespace hammer_loads {

/// Works from when it is made until it is destroyed.
class LiveNode {
 public:
  virtual ~LiveNode() = default;
};

/// The hammer's node from its private parameters; every problem is reported on one line each and gives no node.
std::unique_ptr<LiveNode> makeHammerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                         std::vector<std::string>& problems);

}  // namespace hammer_loads
