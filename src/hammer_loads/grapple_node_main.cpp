/// grapple_node: the live grapple.
#include <ros/init.h>
#include <ros/spinner.h>

#include <csignal>
#include <iostream>

#include "hammer_loads/ros/grapple_node.h"
#include "hammer_loads/ros/steady_memory.h"

int main(int argc, char** argv) {
  hammer_loads::keepMemorySteady();
  ros::init(argc, argv, "grapple");
  // roscpp ends cleanly on SIGINT only; a log must survive SIGTERM as well.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle node, private_node("~");
  std::vector<std::string> problems;
  const auto grapple_node = hammer_loads::makeGrappleNode(node, private_node, problems);
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  if (!grapple_node) return 1;
  ros::spin();
  return 0;
}
