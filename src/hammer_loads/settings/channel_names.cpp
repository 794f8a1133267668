#include "hammer_loads/settings/channel_names.h"

namespace hammer_loads {

std::vector<std::string> channelNames(const Boom* boom) {
  std::vector<std::string> names{"hull_wrench/force_x_N", "hull_wrench/force_z_N", "hull_wrench/torque_y_Nm"};
  if (boom == nullptr) return names;
  for (const std::string& joint : boom->chain().jointNames())
    names.push_back("joint_loads/" + joint + "/total_torque_Nm");
  for (const Cylinder& cylinder : boom->cylinders())
    names.push_back("joint_loads/" + cylinder.parameters().name + "/cylinder_force_N");
  for (const Section& section : boom->sections()) {
    for (const char* field : {"force_x_N", "force_y_N", "force_z_N", "torque_x_Nm", "torque_y_Nm", "torque_z_Nm"})
      names.push_back("section_loads/" + section.name() + "/" + field);
  }
  return names;
}

}  // namespace hammer_loads
