#include "hammer_loads/ros/ros_parameters.h"

#include <cmath>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

YAML::Node numberNode(double value) {
  if (std::isnan(value)) return YAML::Node(".nan");
  if (std::isinf(value)) return YAML::Node(value > 0.0 ? ".inf" : "-.inf");
  return YAML::Node(numberText(value));
}

}  // namespace

YAML::Node yamlFromXmlRpc(XmlRpc::XmlRpcValue value) {
  YAML::Node node(YAML::NodeType::Null);
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value) ? "true" : "false");
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return numberNode(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return textNode(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray:
      node = YAML::Node(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) node.push_back(yamlFromXmlRpc(value[i]));
      return node;
    case XmlRpc::XmlRpcValue::TypeStruct:
      node = YAML::Node(YAML::NodeType::Map);
      for (auto& [key, item] : value) node.force_insert(key, yamlFromXmlRpc(item));
      return node;
    default:  // no parameter here is a date or binary data
      return node;
  }
}

ParameterMap privateParameters(const ros::NodeHandle& private_node, std::vector<std::string>& problems) {
  XmlRpc::XmlRpcValue value;
  if (!private_node.getParam(private_node.getNamespace(), value)) return {};
  return parameterMap(yamlFromXmlRpc(value), private_node.getNamespace(), problems).value_or(ParameterMap{});
}

Checked<Settings> loadPrivateParameters(const ros::NodeHandle& private_node) {
  std::vector<std::string> problems;
  ParameterMap given = privateParameters(private_node, problems);
  for (const char* foreign : {"robot_description", "diagnostic_period"}) given.erase(foreign);  // not from our files
  std::string key, robot_description;
  if (private_node.searchParam("robot_description", key)) private_node.getParam(key, robot_description);
  return behind(problems, load(configDirectory(), given, robot_description));
}

}  // namespace hammer_loads
