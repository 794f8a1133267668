/// Parameters of a node in the form of parameter files, for the same reader.
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Converts a value and keeps its type: a text that looks like a number remains a text.
YAML::Node yamlFromXmlRpc(XmlRpc::XmlRpcValue value);

/// Returns every parameter in the node's private namespace.
ParameterMap privateParameters(const ros::NodeHandle& private_node, std::vector<std::string>& problems);

/// Calls hammer_loads::load for a node, with its private parameters over the shipped ones and the robot description.
/// The latter is the text of `robot_description`, searched from the private namespace upwards.
Checked<Settings> loadPrivateParameters(const ros::NodeHandle& private_node);

}  // namespace hammer_loads
