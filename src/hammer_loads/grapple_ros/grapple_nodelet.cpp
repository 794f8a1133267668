#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "hammer_loads/grapple_ros/live_grapple.h"

namespace hammer_loads {

/// The live grapple within a nodelet manager: the same class, fed without serialisation.
class GrappleNodelet : public nodelet::Nodelet {
  void onInit() override {
    std::vector<std::string> problems;
    node_ = makeGrappleNode(getNodeHandle(), getPrivateNodeHandle(), problems);
    for (const std::string& problem : problems) NODELET_FATAL("%s", problem.c_str());
    if (!node_) throw std::runtime_error("bad parameters: nothing is published");
  }

  std::unique_ptr<LiveNode> node_;
};

}  // namespace hammer_loads

PLUGINLIB_EXPORT_CLASS(hammer_loads::GrappleNodelet, nodelet::Nodelet)
