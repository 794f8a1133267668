/// Conversion of a robot description to KDL's bodies. kdl_parser of ROS does the same, but depends on roscpp.
#pragma once

#include <urdf_model/model.h>

#include <kdl/tree.hpp>

namespace hammer_loads {

/// Every link as a segment of its own name, with its mass and inertia; a joint that neither turns about an axis nor
/// slides along one counts as fixed. The root's inertia is left out, as KDL has none for it. The model must be a tree
/// (RobotDescription).
KDL::Tree treeOf(const urdf::ModelInterface& model);

}  // namespace hammer_loads
