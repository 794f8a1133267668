#include "hammer_loads/settings/channel_names.h"

namespace hammer_loads {

std::vector<std::string> channelNames(const Boom* boom) {
  std::vector<std::string> names{"hull_wrench/force_x_N", "hull_wrench/force_z_N", "hull_wrench/torque_y_Nm"};
  if (boom == nullptr) return names;
  for (const std::string& joint : boom->chain().jointNames())
    names.push_back("joint_loads/" + joint + "/total_torque_Nm");
  for (const Cylinder& cylinder : boom->cylinders())
    names.push_back("joint_loads/" + cylinder.parameters().name + "/cylinder_force_N");
  return names;
}

}  // namespace hammer_loads
