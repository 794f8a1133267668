#include "hammer_loads/ros/bag_report.h"

#include <algorithm>

#include "hammer_loads/ros/loads_flow.h"

namespace hammer_loads {

void addOnce(std::vector<std::string>& lines, const std::string& line) {
  if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
}

void add(const IntakeCounts& counts, IntakeCounts& sum) {
  sum.accepted += counts.accepted;
  sum.restarts += counts.restarts;
  for (std::size_t i = 0; i < counts.refused.size(); ++i) sum.refused[i] += counts.refused[i];
}

void addWarnings(const LoadsFlow& flow, std::vector<std::string>& warnings) {
  const Pipeline& pipeline = flow.pipeline();
  const InputTopics& topics = flow.settings().input_topics;
  if (pipeline.unitCheck().looksLikeDegrees())
    addOnce(warnings, topics.crank + ": angle or speed seems to be in degrees, must be in radians");
  if (pipeline.hullPitch().looksLikeDegrees())
    addOnce(warnings, topics.joint_states + ": joint angles seem to be in degrees, must be in radians");
  const bool imu_suffices = flow.needsImu() && pipeline.imuCounts().missed == 0;
  std::string unheard;
  for (const std::string& joint : pipeline.hullPitch().unheard()) unheard += (unheard.empty() ? "" : ", ") + joint;
  if (!unheard.empty() && !imu_suffices)
    addOnce(warnings, topics.joint_states + ": no angle of " + unheard + ": weight by hull_pitch_rad");
  if (flow.needsImu() && pipeline.imuCounts().missed > 0 && pipeline.imuCounts().accepted > 0)
    addOnce(warnings, topics.hull_imu + ": no reading at " + std::to_string(pipeline.imuCounts().missed) +
                          " crank samples: weight by pitch there");
}

std::string textOf(const BagReport& report) {
  std::string text;
  for (std::size_t i = 0; i < report.crank.refused.size(); ++i) {
    if (report.crank.refused[i] == 0) continue;
    text += std::string("crank samples without a wrench, ") + kRefusalNames[i] + ": " +
            std::to_string(report.crank.refused[i]) + "\n";
  }
  return text + report.grapple;
}

std::string summaryOf(const BagReport& report) {
  std::string text;
  if (report.samples > 0)
    text = std::to_string(report.samples) + " crank samples, " + std::to_string(report.wrenches) + " wrenches, " +
           std::to_string(report.turns) + " turns";
  if (report.runs > 1) text += " in " + std::to_string(report.runs) + " runs";
  if (report.jaw_edges > 0)
    text += (text.empty() ? "" : "; ") + std::to_string(report.jaw_edges) + " slider samples with jaw edges";
  return text;
}

}  // namespace hammer_loads
