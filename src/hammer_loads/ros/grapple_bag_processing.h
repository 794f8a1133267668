/// The grapple's part of a recorded bag.
#pragma once

#include <string>

#include "hammer_loads/ros/grapple_flow.h"

namespace hammer_loads {

/// Reasons of the samples that gave no jaw edge, one line each; empty if all did.
std::string refusalReport(const GrappleFlow& flow);

}  // namespace hammer_loads
