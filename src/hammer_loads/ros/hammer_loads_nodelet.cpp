#include "hammer_loads/ros/live_nodelet.h"

namespace hammer_loads {
class HammerLoadsNodelet : public LiveNodelet<makeHammerNode> {};
}  // namespace hammer_loads

PLUGINLIB_EXPORT_CLASS(hammer_loads::HammerLoadsNodelet, nodelet::Nodelet)
