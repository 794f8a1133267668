#include <urdf_model/model.h>

#include <algorithm>

#include "hammer_loads/boom/chain.h"

namespace hammer_loads {
namespace {

/// Returns true if the link lies beyond every joint, or is a joint's own.
bool isBeyond(urdf::LinkConstSharedPtr link, const std::vector<std::string>& joints) {
  std::size_t met = 0;
  for (; link && link->parent_joint; link = link->getParent())
    met += static_cast<std::size_t>(std::count(joints.begin(), joints.end(), link->parent_joint->name));
  return met == joints.size();
}

std::size_t depth(urdf::LinkConstSharedPtr link) {
  std::size_t steps = 0;
  for (; link && link->parent_joint; link = link->getParent()) ++steps;
  return steps;
}

bool isBefore(const std::string& name, urdf::LinkConstSharedPtr link) {
  while (link && link->name != name) link = link->getParent();
  return link != nullptr;
}

}  // namespace

std::optional<ChainRequest> chainOver(const RobotDescription& description, const std::vector<std::string>& joints) {
  const urdf::ModelInterface* model = description.model();
  if (model == nullptr || joints.empty()) return std::nullopt;
  urdf::LinkConstSharedPtr first, last;
  for (const std::string& name : joints) {
    const urdf::JointConstSharedPtr joint = model->getJoint(name);
    if (!joint) return std::nullopt;
    const urdf::LinkConstSharedPtr before = model->getLink(joint->parent_link_name),
                                   beyond = model->getLink(joint->child_link_name);
    if (!first || depth(before) < depth(first)) first = before;
    if (!last || depth(beyond) > depth(last)) last = beyond;
  }
  if (!isBeyond(last, joints)) return std::nullopt;
  ChainRequest request;
  const urdf::LinkConstSharedPtr hull = model->getLink(request.tip);
  if (!hull || !isBefore(last->name, hull)) request.tip = last->name;
  if (!isBefore(request.root, first)) request.root = model->getRoot()->name;
  request.joints = joints;
  request.massless = true;
  return request;
}

}  // namespace hammer_loads
