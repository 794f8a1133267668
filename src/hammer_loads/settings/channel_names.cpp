#include "hammer_loads/settings/channel_names.h"

namespace hammer_loads {

std::vector<std::string> channelNames(const Boom* boom) {
  std::vector<std::string> names{"hull_wrench/force_x", "hull_wrench/force_z", "hull_wrench/torque_y"};
  if (boom == nullptr) return names;
  for (const std::string& joint : boom->chain().jointNames()) names.push_back("joint_loads/" + joint + "/total_torque");
  for (const Cylinder& cylinder : boom->cylinders())
    names.push_back("joint_loads/" + cylinder.parameters().name + "/force");
  for (const Section& section : boom->sections()) {
    for (const char* field : {"force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"})
      names.push_back("section_loads/" + section.name() + "/" + field);
  }
  return names;
}

}  // namespace hammer_loads
