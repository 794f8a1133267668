/// From the text of a robot description to a model, with every complaint in our own words and none on the console.
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <string>
#include <vector>

namespace hammer_loads {

/// Null when the text is no URDF, passes a limit (UrdfLimits) or is no tree. Problems, one line each: why, or a link
/// whose mass or inertia no body can have (negative, not finite, beyond every machine, or principal moments that
/// violate the triangle inequality), or a joint whose place or axis is none.
urdf::ModelInterfaceSharedPtr readUrdf(const std::string& text, std::vector<std::string>& problems);

}  // namespace hammer_loads
