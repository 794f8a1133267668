#include "hammer_loads/grapple_ros/grapple_node.h"
#include "hammer_loads/ros/live_nodelet.h"

namespace hammer_loads {
class GrappleNodelet : public LiveNodelet<makeGrappleNode> {};
}  // namespace hammer_loads

PLUGINLIB_EXPORT_CLASS(hammer_loads::GrappleNodelet, nodelet::Nodelet)
