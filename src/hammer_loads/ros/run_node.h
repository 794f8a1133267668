/// Process of a node: answers to --help and --version, memory settings, main loop.
#pragma once

#include <malloc.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <csignal>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/ros/version.h"

namespace hammer_loads {

/// Answers --help and --version, which need no ROS master. Returns the exit code if the first argument is one of them;
/// returns nothing if the node may start.
inline std::optional<int> answerUsage(int argc, char** argv, const std::string& usage) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--version") {
    std::cout << "hammer_loads " << packageVersion() << std::endl;
  } else if (first == "--help" || first == "-h") {
    std::cout << usage << std::flush;
  } else {
    return std::nullopt;
  }
  return std::cout ? 0 : 1;
}

/// Returns large blocks to the system when they are freed. Call it first in a program's main; a library must not change
/// the heap of its process. By default glibc keeps freed blocks up to the size of the largest one freed so far. The
/// buffers that grow with every bag then lie among small blocks and fragment the heap over hours (doc/reliability.md,
/// log soak).
inline void keepMemorySteady() noexcept {
  constexpr int kLargeBlock = 128 * 1024;  // glibc's own initial value [byte]
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
}

/// Runs a node and returns the exit code. make: function such as makeHammerNode; null ends the program with code 1.
/// Every problem is a line on stderr.
template <typename Make>
int runNode(int argc, char** argv, const std::string& usage, const char* name, Make make) {
  if (const auto code = answerUsage(argc, argv, usage)) return *code;
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
