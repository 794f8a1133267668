#include "hammer_loads/calibration/boom_report.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

double percent(double part, double whole) { return whole > 0.0 ? 100.0 * part / whole : 0.0; }

/// Keys and values in the order of the file.
using KeyLines = std::vector<std::pair<std::string, std::string>>;

KeyLines linesOf(const std::string& yaml) {
  KeyLines keys;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t colon = line.find(':'); colon != std::string::npos)
      keys.emplace_back(line.substr(0, colon), line.substr(colon + 1));
  return keys;
}

void put(KeyLines& lines, const std::string& key, const std::string& value) {
  const auto same = std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.first == key; });
  (same == lines.end() ? lines.emplace_back(key, "") : *same).second = " " + value;
}

/// Puts the numbers of a cylinder, a link or a section, whose name precedes each key.
void put(KeyLines& lines, const std::string& name, const std::vector<std::pair<const char*, double>>& numbers) {
  for (const auto& [key, number] : numbers) put(lines, name + key, numberText(number));
}

struct Panel {
  double left{}, top{}, width{}, height{};
  double low{}, high{}, most{};  ///< range of the angle [rad]; largest force [N]
  double x(double angle) const { return left + width * (angle - low) / (high - low); }
  double y(double force) const { return top + 0.5 * height * (1.0 - std::clamp(force / most, -1.0, 1.0)); }
};

std::string panelOf(const BoomCalibration& c, std::size_t cylinder, Panel panel) {
  panel.low = kInfinity, panel.high = -kInfinity;
  for (const BoomResidual& r : c.residuals) {
    if (r.cylinder != cylinder) continue;
    panel.low = std::min(panel.low, r.angle), panel.high = std::max(panel.high, r.angle);
    panel.most = std::max({panel.most, std::abs(r.before), std::abs(r.after)});
  }
  if (!(panel.high > panel.low) || !(panel.most > 0.0)) return {};
  const CylinderFit& fit = c.cylinders[cylinder];
  std::string svg = format(
      "<text x=\"%.0f\" y=\"%.0f\">%s: measured less expected force over the angle of its joint, within %.0f N</text>\n"
      "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#bbb\"/>\n"
      "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#bbb\"/>\n",
      panel.left, panel.top - 6.0, fit.name.c_str(), panel.most, panel.left, panel.top, panel.width, panel.height,
      panel.left, panel.y(0.0), panel.left + panel.width, panel.y(0.0));
  for (const BoomResidual& r : c.residuals) {
    if (r.cylinder != cylinder) continue;
    svg += format(
        "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2\" fill=\"%s\"/><circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" "
        "fill=\"#1f5fa8\"/>\n",
        panel.x(r.angle), panel.y(r.before), r.extends ? "#e08a7e" : "#e0b87e", panel.x(r.angle), panel.y(r.after));
  }
  for (const double angle : {panel.low, panel.high})
    svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%.2f rad</text>\n", panel.x(angle),
                  panel.top + panel.height + 16.0, angle);
  return svg;
}

std::string cylinderLine(const CylinderFit& f) {
  return format(
      "%-20s %zu instants, force %.0f N rms; off before %.1f %%, left %.2f %%, last quarter by the others %.2f "
      "%%%s; friction %.0f +- %.0f N (%.1f %%)\n",
      f.name.c_str(), f.rows, f.force, percent(f.before, f.force), percent(f.left, f.force),
      percent(f.held_out, f.force), f.holds() ? "" : ": DOES NOT FIT, nothing is written", f.friction, f.friction_std,
      percent(f.friction, f.force));
}

/// Returns the residuals of each recording; empty if there is only one recording.
std::string recordingLine(const CylinderFit& f, const std::vector<std::string>& names) {
  std::vector<std::string> texts;
  for (std::size_t r = 0; r < f.left_in.size(); ++r)
    if (std::isfinite(f.left_in[r]))
      texts.push_back(format("%s %.2f %%", names[r].c_str(), percent(f.left_in[r], f.force)));
  return texts.empty() ? "" : "  left in " + joined(texts) + "\n";
}

std::string jointLine(const JointWeight& j) {
  return format("%-20s weight makes %.0f +- %.0f N m rms (%.2f %%, limit %.0f %%)%s; as given it was off by %.1f %%\n",
                j.joint.c_str(), j.torque, j.deviation, 100.0 * j.part(), 100.0 * BoomCalibration::kLimit,
                j.part() <= BoomCalibration::kLimit ? "" : ": NOT DETERMINED, nothing is written",
                percent(j.before, j.torque));
}

}  // namespace

std::string textOf(const BoomCalibration& c) {
  if (!c.problem.empty()) return c.problem + "\n";
  std::string text = format("%.0f s, %zu instants, %zu left out\n", c.seconds, c.points, c.left_out);
  for (const JointWeight& joint : c.joints) text += jointLine(joint);
  for (const CylinderFit& cylinder : c.cylinders) text += cylinderLine(cylinder) + recordingLine(cylinder, c.names);
  for (const Estimate& e : c.estimates)
    text += format("%-40s %.6g%s%s +- %.2g, before +- %.2g; %s\n", e.key.c_str(), e.value, e.unit.empty() ? "" : " ",
                   e.unit.c_str(), e.deviation, e.limit, e.meaning.c_str());
  if (c.weight_check)
    text += format("a boom weighed without it gives %.1f +- %.1f kg on the tip; %s\n", c.weight_check->value,
                   c.weight_check->deviation, c.weight_check->meaning.c_str());
  return text + notesOf(c);
}

std::string yamlOf(const BoomCalibration& c, const std::string& given, const std::string& source) {
  if (!c.determined()) return {};
  KeyLines lines = linesOf(given);
  for (const CylinderParameters& p : c.found.cylinders)
    put(lines, p.name,
        {{"_friction", p.friction},
         {"_friction_std", p.friction_std},
         {"_friction_force_N", p.friction_force},
         {"_friction_force_std_N", p.friction_force_std},
         {"_joint_zero_rad", p.joint_zero},
         {"_joint_zero_std_rad", p.joint_zero_std},
         {"_pressure_offset_Pa", p.pressure_offset},
         {"_pressure_offset_std_Pa", p.pressure_offset_std}});
  std::vector<std::string> names;
  for (const WeighedLink& link : c.found.chain.weighed) names.push_back(link.name);
  put(lines, "weighed_links", "[" + joined(names) + "]");
  for (const WeighedLink& link : c.found.chain.weighed)
    put(lines, link.name,
        {{"_mass_kg", link.mass},
         {"_com_x_m", link.com_x},
         {"_com_z_m", link.com_z},
         {"_inertia_kg_m2", link.inertia},
         {"_moment_x_std_kg_m", link.moment_x_std},
         {"_moment_z_std_kg_m", link.moment_z_std}});
  for (const SectionParameters& section : c.found.sections)
    if (section.beyond)
      put(lines, section.name + "_section",
          {{"_mass_beyond_kg", section.beyond->mass}, {"_inertia_beyond_kg_m2", section.beyond->inertia_y}});
  std::string text = std::string(kBoomYamlBegins) + " " + onOneLine(source) + ":\n";
  for (const JointWeight& joint : c.joints) text += "# " + jointLine(joint);
  for (const CylinderFit& cylinder : c.cylinders) text += "# " + cylinderLine(cylinder);
  text += "# A whole boom file, for boom_file:=FILE or --params. Values belong together: some cannot be separated.\n";
  for (const auto& [key, value] : lines) text += key + ":" + value + "\n";
  return text;
}

std::string svgOf(const BoomCalibration& c) {
  constexpr double kWidth = 900.0, kPanel = 220.0, kTop = 70.0;
  // Numerical: kWidth, kPanel, kTop
  const double height = kTop + kPanel * static_cast<double>(c.cylinders.size()) + 10.0;
  std::string svg = format(
      "%s xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" font-family=\"sans-serif\" "
      "font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
      "<text x=\"40\" y=\"22\" font-size=\"16\">What is left of the cylinders' forces</text>\n"
      "<text x=\"40\" y=\"42\" fill=\"#c0392b\">as given: rod out (red), rod in (yellow)</text>"
      "<text x=\"340\" y=\"42\" fill=\"#1f5fa8\">with the values found</text>\n",
      kBoomSvgBegins, kWidth, height);
  for (std::size_t k = 0; k < c.cylinders.size(); ++k)
    svg += panelOf(c, k, {40.0, kTop + kPanel * static_cast<double>(k), kWidth - 80.0, kPanel - 50.0, 0.0, 0.0, 0.0});
  return svg + "</svg>\n";
}

}  // namespace hammer_loads::calibration
