#include "hammer_loads/ros/bag_report.h"

#include <algorithm>

namespace hammer_loads {

void addOnce(std::vector<std::string>& lines, const std::string& line) {
  if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
}

void addOnce(std::vector<BagWarning>& warnings, const BagWarning& warning) {
  const bool known = std::any_of(warnings.begin(), warnings.end(), [&](const BagWarning& other) {
    return other.run == warning.run && other.text == warning.text;
  });
  if (!known) warnings.push_back(warning);
}

std::vector<std::string> textsOf(const std::vector<BagWarning>& warnings) {
  std::vector<std::string> texts;
  for (const BagWarning& warning : warnings) addOnce(texts, warning.text);
  return texts;
}

void add(const SampleCounts& counts, SampleCounts& sum) {
  sum.accepted += counts.accepted;
  sum.beside_blow += counts.beside_blow;
  sum.uncertain += counts.uncertain;
  sum.restarts += counts.restarts;
  sum.blows += counts.blows;
  sum.impossible_blows += counts.impossible_blows;
  sum.backward_passes += counts.backward_passes;
  sum.misuse.add(counts.misuse);
  for (std::size_t i = 0; i < counts.refused.size(); ++i) sum.refused[i] += counts.refused[i];
}

std::string textOf(const BagReport& report) {
  constexpr double kMuch = 0.02;  // share of the samples; in a good recording half a per cent are close to a blow
  std::string text;
  for (std::size_t i = 0; i < report.crank.refused.size(); ++i) {
    if (report.crank.refused[i] == 0) continue;
    text += std::string("crank samples without a wrench, ") + kRefusalNames[i] + ": " +
            std::to_string(report.crank.refused[i]) + "\n";
  }
  if (static_cast<double>(report.crank.beside_blow) > kMuch * static_cast<double>(report.samples))
    text += "crank samples closer to the blow than the angle is known, not published: " +
            std::to_string(report.crank.beside_blow) + "\n";
  return text;
}

std::string summaryOf(const BagReport& report) {
  std::string text = std::to_string(report.samples) + " crank samples, " + std::to_string(report.wrenches) +
                     " wrenches, " + std::to_string(report.turns) + " turns";
  if (report.runs > 1) text += " in " + std::to_string(report.runs) + " runs";
  if (!report.prefix.empty()) text += ", written under " + report.prefix;
  return text;
}

}  // namespace hammer_loads
