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

YAML::Node listNode(const XmlRpc::XmlRpcValue& list) {
  YAML::Node node(YAML::NodeType::Sequence);
  for (int i = 0; i < list.size(); ++i) node.push_back(yamlFromXmlRpc(list[i]));
  return node;
}

YAML::Node mapNode(XmlRpc::XmlRpcValue& map) {
  YAML::Node node(YAML::NodeType::Map);
  for (auto& [key, value] : map) node.force_insert(key, yamlFromXmlRpc(value));
  return node;
}

}  // namespace

YAML::Node yamlFromXmlRpc(XmlRpc::XmlRpcValue value) {
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
      return listNode(value);
    case XmlRpc::XmlRpcValue::TypeStruct:
      return mapNode(value);
    case XmlRpc::XmlRpcValue::TypeInvalid:
    case XmlRpc::XmlRpcValue::TypeDateTime:
    case XmlRpc::XmlRpcValue::TypeBase64:
      break;
  }
  return YAML::Node(YAML::NodeType::Null);  // nothing here has a date or binary data
}

ParameterMap privateParameters(const ros::NodeHandle& private_node, std::vector<std::string>& problems) {
  XmlRpc::XmlRpcValue value;
  if (!private_node.getParam(private_node.getNamespace(), value)) return {};
  return parameterMap(yamlFromXmlRpc(value), private_node.getNamespace(), problems).value_or(ParameterMap{});
}

std::string robotDescription(const ros::NodeHandle& private_node) {
  std::string key, text;
  if (private_node.searchParam("robot_description", key)) private_node.getParam(key, text);
  return text;
}

Checked<Settings> loadPrivateParameters(const ros::NodeHandle& private_node) {
  std::vector<std::string> problems;
  ParameterMap given = privateParameters(private_node, problems);
  for (const char* foreign : {"robot_description", "diagnostic_period"}) given.erase(foreign);  // not from our files
  Checked<Settings> result = load(configDirectory(), given, robotDescription(private_node));
  result.problems.insert(result.problems.begin(), problems.begin(), problems.end());
  if (!result.problems.empty()) result.value.reset();
  return result;
}

}  // namespace hammer_loads
