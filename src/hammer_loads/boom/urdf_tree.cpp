#include "hammer_loads/boom/urdf_tree.h"

namespace hammer_loads {
namespace {

KDL::Vector toKdl(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }
KDL::Frame toKdl(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return {KDL::Rotation::Quaternion(q.x, q.y, q.z, q.w), toKdl(pose.position)};
}

KDL::Joint toKdl(const urdf::Joint& joint) {
  const KDL::Frame place = toKdl(joint.parent_to_joint_origin_transform);
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      return KDL::Joint(joint.name, place.p, place.M * toKdl(joint.axis), KDL::Joint::RotAxis);
    case urdf::Joint::PRISMATIC:
      return KDL::Joint(joint.name, place.p, place.M * toKdl(joint.axis), KDL::Joint::TransAxis);
    default:
      return KDL::Joint(joint.name, KDL::Joint::None);
  }
}

/// The description states the inertia about the centre of mass in its own axes; KDL expects the link's axes.
KDL::RigidBodyInertia toKdl(const urdf::InertialSharedPtr& body) {
  if (!body) return KDL::RigidBodyInertia::Zero();
  const KDL::Frame place = toKdl(body->origin);
  const KDL::RotationalInertia own(body->ixx, body->iyy, body->izz, body->ixy, body->ixz, body->iyz);
  const KDL::RigidBodyInertia turned = place.M * KDL::RigidBodyInertia(0.0, KDL::Vector::Zero(), own);
  return KDL::RigidBodyInertia(body->mass, place.p, turned.getRotationalInertia());
}

void addChildren(const urdf::Link& link, KDL::Tree& tree) {
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    tree.addSegment(
        KDL::Segment(child->name, toKdl(joint), toKdl(joint.parent_to_joint_origin_transform), toKdl(child->inertial)),
        link.name);
    addChildren(*child, tree);
  }
}

}  // namespace

KDL::Tree treeOf(const urdf::ModelInterface& model) {
  KDL::Tree tree(model.getRoot()->name);
  addChildren(*model.getRoot(), tree);
  return tree;
}

}  // namespace hammer_loads
