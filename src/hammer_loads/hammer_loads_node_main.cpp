/// hammer_loads_node: the live node.
#include <ros/init.h>
#include <ros/spinner.h>

#include <csignal>
#include <iostream>

#include "hammer_loads/ros/hammer_loads_node.h"
#include "hammer_loads/ros/steady_memory.h"

int main(int argc, char** argv) {
  hammer_loads::keepMemorySteady();
  ros::init(argc, argv, "hammer_loads");
  // roscpp ends cleanly on SIGINT only; a log must survive SIGTERM as well.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle node, private_node("~");
  std::vector<std::string> problems;
  const auto hammer_loads_node = hammer_loads::makeNode(node, private_node, problems);
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  if (!hammer_loads_node) return 1;
  ros::spin();
  return 0;
}
