/// Parameters of a node in the form of parameter files, for the same reader.
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Keeps the types of the parameter server: a text that looks like a number remains a text.
YAML::Node yamlFromXmlRpc(XmlRpc::XmlRpcValue value);

/// Every parameter in the node's private name space; none if there are none.
ParameterMap privateParameters(const ros::NodeHandle& private_node, std::vector<std::string>& problems);

/// Private parameters over the shipped ones and the robot description, the text of `robot_description` searched from
/// the private name space upwards: hammer_loads::load for a node.
Checked<Settings> loadPrivateParameters(const ros::NodeHandle& private_node);

}  // namespace hammer_loads
