/// Uses messages and a library with ROS.
#include <hammer_loads/HullLoads.h>
#include <hammer_loads/RunInfo.h>
#include <ros/ros.h>

#include <iostream>

#include "hammer_loads/log/bag_log.h"

int main() {
  std::cout << ros::message_traits::datatype<hammer_loads::HullLoads>() << '\n'
            << ros::message_traits::datatype<hammer_loads::RunInfo>() << '\n';
  hammer_loads::BagLog log({});
  return log.start().empty() ? 1 : 0;  // settings without a directory
}
