#include "hammer_loads/ros/bag_output.h"

#include <hammer_loads/RunInfo.h>

#include <algorithm>

#include "hammer_loads/ros/bag_inputs.h"

namespace hammer_loads {
namespace {

bool beginsWith(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// Outputs are messages of this package, loads and motion of geometry_msgs, and the mechanism's joints.
bool isOutput(const std::string& topic, const BagTopic& found, const std::string& prefix) {
  if (!beginsWith(topic, prefix)) return false;
  return std::all_of(found.types.begin(), found.types.end(), [&](const std::string& type) {
    return beginsWith(type, "hammer_loads/") || beginsWith(type, "geometry_msgs/") || topic == prefix + "mechanism";
  });
}

}  // namespace

std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics) {
  const Checked<BagInputs> bag = BagInputs::open({file});
  if (!bag.value) return "it is no readable bag of this package";
  std::vector<std::string> prefixes;
  for (const auto& [name, topic] : bag.value->topics()) {
    const std::size_t slash = name.rfind('/');
    const bool run_info = topic.types.count(ros::message_traits::datatype<RunInfo>()) != 0;
    if (run_info && slash != std::string::npos && slash > 0) prefixes.push_back(name.substr(0, slash + 1));
  }
  for (const auto& [name, topic] : bag.value->topics()) {
    const bool ours = std::any_of(prefixes.begin(), prefixes.end(), [&, &name = name, &topic = topic](const auto& p) {
      return isOutput(name, topic, p);
    });
    if (!ours) return "it holds " + name + ", which is no output of this package";
    if (std::count(input_topics.begin(), input_topics.end(), name) != 0) return "it holds " + name + ", an input";
  }
  return prefixes.empty() ? "it is no bag of this package: it holds no run_info" : "";
}

}  // namespace hammer_loads
