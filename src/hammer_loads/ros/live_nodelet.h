/// Live node within a nodelet manager: the same class, which receives messages without serialisation.
#pragma once

#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "hammer_loads/ros/live_node.h"

namespace hammer_loads {

/// make: function such as makeHammerNode.
template <auto make>
class LiveNodelet : public nodelet::Nodelet {
  void onInit() override {
    std::vector<std::string> problems;
    node_ = make(getNodeHandle(), getPrivateNodeHandle(), problems);
    for (const std::string& problem : problems) NODELET_FATAL("%s", problem.c_str());
    if (!node_) throw std::runtime_error("bad parameters: nothing is published");
  }

  std::unique_ptr<LiveNode> node_;
};

}  // namespace hammer_loads
