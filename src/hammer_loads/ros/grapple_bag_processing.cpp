#include "hammer_loads/ros/grapple_bag_processing.h"

namespace hammer_loads {

std::string refusalReport(const GrappleFlow& flow) {
  std::string report;
  for (const RefusalCount& refusal : flow.refusals()) {
    if (refusal.count == 0) continue;
    report += "slider samples without a jaw edge, " + refusal.reason + ": " + std::to_string(refusal.count);
    report += refusal.last.empty() ? "\n" : "; the last one: " + refusal.last + "\n";
  }
  if (flow.withoutVelocity() > 0)
    report +=
        "slider samples without a velocity, so without twist and accel: " + std::to_string(flow.withoutVelocity()) +
        "\n";
  return report;
}

}  // namespace hammer_loads
