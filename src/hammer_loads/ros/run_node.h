/// Main loop of a node with a process of its own.
#pragma once

#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <csignal>
#include <iostream>
#include <string>
#include <vector>

#include "hammer_loads/ros/steady_memory.h"

namespace hammer_loads {

/// make: as makeHammerNode; null ends the program with code 1. Every problem is a line on stderr. Returns the exit
/// code.
template <typename Make>
int runNode(int argc, char** argv, const char* name, Make make) {
  keepMemorySteady();
  ros::init(argc, argv, name);
  // roscpp ends cleanly on SIGINT only; a log must survive SIGTERM and a closed terminal as well.
  for (const int signal : {SIGTERM, SIGHUP}) {
    const auto before = std::signal(signal, [](int) { ros::requestShutdown(); });
    if (before == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
  }
  ros::NodeHandle node, private_node("~");
  std::vector<std::string> problems;
  const auto made = make(node, private_node, problems);
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  if (!made) return 1;
  ros::spin();
  return 0;
}

}  // namespace hammer_loads
