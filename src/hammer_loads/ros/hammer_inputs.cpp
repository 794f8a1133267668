#include "hammer_loads/ros/hammer_inputs.h"

#include <algorithm>

namespace hammer_loads {
namespace {

bool needsTransforms(const Settings& settings) {
  const std::vector<std::string>& links = settings.pipeline.boom_wrench_links;
  return std::any_of(links.begin(), links.end(), [&settings](const std::string& link) {
    return !settings.boom || !settings.boom->chain().linkIndex(link);
  });
}

Input<tf2_msgs::TFMessage> transforms(const Settings& settings, const std::string& topic, bool is_static) {
  return {topic,
          [is_static](HammerBridge& bridge, const tf2_msgs::TFMessage& message, const ros::Time& time) {
            bridge.transforms(message, is_static, time);
          },
          needsTransforms(settings), is_static};
}

}  // namespace

std::vector<PressureTopic> pressureTopics(const Settings& settings) {
  std::vector<PressureTopic> topics;
  if (!settings.boom) return topics;
  const std::vector<Cylinder>& cylinders = settings.boom->cylinders();
  for (std::size_t i = 0; i < cylinders.size(); ++i) {
    const std::string name = settings.input_topics.cylinder_pressures + "/" + cylinders[i].parameters().name;
    topics.push_back({name + "/bore", i, Chamber::kBore});
    topics.push_back({name + "/rod", i, Chamber::kRod});
  }
  return topics;
}

HammerInputs::HammerInputs(const Settings& settings)
    : joint_states{settings.input_topics.joint_states, std::mem_fn(&HammerBridge::jointStates)},
      hull_imu{settings.input_topics.hull_imu, std::mem_fn(&HammerBridge::hullImu), needsImu(settings.pipeline)},
      reference{settings.input_topics.reference, std::mem_fn(&HammerBridge::reference)},
      tf_static(transforms(settings, "/tf_static", true)),
      tf(transforms(settings, "/tf", false)),
      crank{settings.input_topics.crank, std::mem_fn(&HammerBridge::crank)} {
  for (const PressureTopic& topic : pressureTopics(settings)) {
    pressures.push_back(
        {topic.name, [cylinder = topic.cylinder, chamber = topic.chamber](
                         HammerBridge& bridge, const sensor_msgs::FluidPressure& message, const ros::Time& time) {
           bridge.cylinderPressure(cylinder, chamber, message, time);
         }});
  }
}

}  // namespace hammer_loads
