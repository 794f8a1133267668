#include "hammer_loads/calibration/report.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

/// Returns a value with its unit; angles are also given in degrees.
std::string shown(double value, const std::string& unit) {
  std::string text = format("%.6g", value);
  if (!unit.empty()) text += " " + unit;
  return unit == "rad" ? text + format(" (%.4g deg)", value / kDegree) : text;
}

std::string needOf(const Calibration& c) {
  const double seconds = c.blows > 0 ? c.seconds / static_cast<double>(c.blows) * c.more_blows : 0.25 * c.more_blows;
  return format("some %.0f blows, %.0f s of such work", std::ceil(c.more_blows), std::ceil(seconds));
}

/// Returns key and value to the second digit of the deviation.
std::string briefly(const Estimate& e) {
  const bool sure = !(e.deviation > 0.0);
  const int decimals = sure ? 0 : std::clamp(1 - static_cast<int>(std::floor(std::log10(e.deviation))), 0, 9);
  const bool tiny = decimals > 6;
  std::string text = e.key + (sure || tiny ? format(" %.4g", e.value) : format(" %.*f", decimals, e.value));
  if (!e.unit.empty()) text += " " + e.unit;
  if (e.unit == "rad" && !sure) text += format(" (%.2f deg)", e.value / kDegree);
  return sure ? text : text + format(" +- %.2g", e.deviation);
}

/// Returns the determined keys, without those that are zero or belong to another key (standard deviation, phase).
std::string foundOf(const Calibration& c) {
  std::vector<std::string> texts;
  for (const Estimate& e : c.estimates) {
    const bool of_another = e.key.find("_std") != std::string::npos || e.key.find("_phase") != std::string::npos;
    if (e.determined() && e.value != 0.0 && !of_another) texts.push_back(briefly(e));
  }
  return joined(texts);
}

std::string whyNotFound(const Calibration& c, const Estimate& e) {
  if (c.rod_is_elastic) return "the connecting rod or its pins are elastic";
  if (!e.hidden_by.empty()) return "hidden by the uncertainty of " + e.hidden_by;
  return std::isfinite(c.more_blows) ? "too few blows" : "this work does not show it";
}

/// Returns the undetermined keys by reason, in their order.
std::vector<std::pair<std::string, std::string>> notFoundOf(const Calibration& c) {
  std::vector<std::pair<std::string, std::string>> found;
  for (const Estimate& e : c.estimates) {
    if (e.determined() || e.key.find("_phase") != std::string::npos) continue;
    const std::string reason = whyNotFound(c, e),
                      key = e.key + format(" (+- %.2g, must be %.2g)", e.deviation, e.limit);
    const auto same = [&](const auto& one) { return one.first == reason; };
    const auto place = std::find_if(found.begin(), found.end(), same);
    if (place != found.end()) {
      place->second += ", " + key;
    } else {
      found.emplace_back(reason, key);
    }
  }
  return found;
}

/// Returns advice for the keys that were not found, otherwise the use of the file.
std::string nextStepOf(const Calibration& c) {
  constexpr double kLargeResidual = 1.3;  // limit stated in doc/your_machine.md
  // Warning: kLargeResidual
  if (c.rod_is_elastic)
    return "more such work does not help: turn the crank by hand, without blows, until the rocker rests on its tool "
           "with crank and rod in line; "
           "write that reading as crank_zero_rad, and set level: elastic";
  std::vector<std::string> steps, measured;
  bool few = false, at_other_level = false;
  for (const Estimate& e : c.estimates) {
    if (e.determined()) continue;
    few = few || e.hidden_by.empty();
    if (e.hidden_by.empty() || std::find(measured.begin(), measured.end(), e.hidden_by) != measured.end()) continue;
    if (indexOfConstant(e.hidden_by)) {
      measured.push_back(e.hidden_by);
    } else {
      at_other_level = true;
    }
  }
  if (!measured.empty()) steps.push_back("weigh or measure " + joined(measured) + " and give its standard deviation");
  if (at_other_level) steps.emplace_back("set level: linkage");
  if (c.mean_square > square(kLargeResidual))
    steps.emplace_back("check the lengths of the hammer file and the stamps, for the residuals are above 1.3");
  if (few && std::isfinite(c.more_blows)) steps.push_back("record " + needOf(c));
  if (steps.empty()) return "start the node with this file as calibration_file:=FILE, or give it to --params";
  return joined(steps, "; ") + "; then calibrate again (--verbose shows every figure)";
}

/// Wraps a text to lines of some 110 characters, the second and later ones indented. A line ends behind a comma, colon
/// or semicolon, so that a key stays beside its value.
std::string wrapped(const std::string& text) {
  constexpr std::size_t kLongestLine = 110;  // Numerical: kLongestLine
  std::string lines, line;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end) {
    end = text.find_first_of(",:;", begin);
    end = end == std::string::npos ? text.size() : end + 1;
    if (!line.empty() && line.size() + end - begin > kLongestLine) lines += line + "\n", line = "   ";
    line += text.substr(begin, end - begin);
  }
  return lines + line + "\n";
}

/// Returns true if a key is determined other than direction, counts and jitter, which any turning crank shows.
bool anyDetermined(const Calibration& c) {
  return std::any_of(c.estimates.begin(), c.estimates.end(), [](const Estimate& e) {
    return e.determined() && e.deviation > 0.0 && e.key != "crank_timing_noise_s";
  });
}

/// Returns the smallest of 1, 2 and 5 times a power of ten that is not below `least`.
double tickStep(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10.0 * power;
}

/// Panel with one curve on its own scale, in degrees.
struct ResidualPanel {
  static constexpr double kLeft = 80.0, kRight = 740.0, kHeight = 180.0;  // Numerical: kLeft, kRight, kHeight
  double top;
  const ResidualCurve& curve;
  const char *title, *colour;

  static double x(double part) { return kLeft + (kRight - kLeft) * part; }
  /// Returns the largest value of the curve with its bars, at least 0.01 deg.
  double largest() const {
    double value = 0.01;
    for (std::size_t i = 0; i < curve.mean.size(); ++i)
      if (std::isfinite(curve.mean[i]))
        value = std::max(value, (std::abs(curve.mean[i]) + 2.0 * curve.deviation[i]) / kDegree);
    return value;
  }
};

std::string svgOf(const ResidualPanel& panel) {
  const double step = tickStep(panel.largest() / 3.0), most = step * std::ceil(panel.largest() / step);
  const double middle = panel.top + 0.5 * ResidualPanel::kHeight, bottom = panel.top + ResidualPanel::kHeight;
  const auto y = [&](double degrees) { return middle - 0.5 * ResidualPanel::kHeight * degrees / most; };
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step))));
  std::string svg = format("<text x=\"%.0f\" y=\"%.1f\" fill=\"%s\">%s (bars: two standard deviations)</text>\n",
                           ResidualPanel::kLeft, panel.top - 10.0, panel.colour, panel.title);
  for (int degree = -180; degree <= 180; degree += 60) {
    const double at = ResidualPanel::x(degree / 360.0 + 0.5);
    svg += format(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n"
        "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%d</text>\n",
        at, panel.top, at, bottom, at, bottom + 18.0, degree);
  }
  const int ticks = static_cast<int>(std::lround(most / step));
  for (int tick = -ticks; tick <= ticks; ++tick) {
    const double at = y(tick * step);
    svg += format(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n"
        "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.*f</text>\n",
        ResidualPanel::kLeft, at, ResidualPanel::kRight, at, tick == 0 ? "#888" : "#ddd", ResidualPanel::kLeft - 6.0,
        at + 4.0, decimals, tick * step);
  }
  svg += format("<text transform=\"translate(20 %.1f) rotate(-90)\" text-anchor=\"middle\">residual [deg]</text>\n",
                middle);
  std::string points;
  const auto n = static_cast<double>(panel.curve.mean.size());
  for (std::size_t i = 0; i < panel.curve.mean.size(); ++i) {
    const double mean = panel.curve.mean[i] / kDegree, bar = 2.0 * panel.curve.deviation[i] / kDegree;
    if (!std::isfinite(mean)) continue;
    const double at = ResidualPanel::x((static_cast<double>(i) + 0.5) / n);
    points += format("%.1f,%.1f ", at, y(mean));
    svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-opacity=\"0.35\"/>\n", at,
                  y(mean - bar), at, y(mean + bar), panel.colour);
  }
  return svg + format("<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"%s\" points=\"%s\"/>\n", panel.colour,
                      points.c_str());
}

}  // namespace

std::string textOf(const Calibration& c, bool verbose) {
  if (!c.problem.empty())
    return c.problem + (std::isfinite(c.more_blows) ? "; needed are " + needOf(c) : "; more such work does not help") +
           "\n";
  std::string text =
      format("%.1f s, %zu blows, %zu left out; residuals over their deviation (1: nothing but noise): %.3f\n",
             c.seconds, c.blows, c.left_out, std::sqrt(c.mean_square));
  const std::string found = foundOf(c);
  if (!found.empty()) text += wrapped("found: " + found);
  for (const auto& [reason, keys] : notFoundOf(c)) text += wrapped("not found: " + keys + ": " + reason);
  text += wrapped("next: " + nextStepOf(c));
  if (!verbose) return text;
  text += format("\n%.3g samples a second%s\n", 1.0 / c.facts.period, c.facts.retimed ? ", re-timed" : "");
  for (const Estimate& e : c.estimates) {
    text += format("%-34s %s +- %.2g, limit %.2g%s; %s\n", e.key.c_str(), shown(e.value, e.unit).c_str(), e.deviation,
                   e.limit, e.determined() ? "" : ": NOT DETERMINED, not written", e.meaning.c_str());
  }
  for (const Correlation& r : c.correlations)
    text += format("strong correlation %+.3f: %s and %s\n", r.value, r.first.c_str(), r.second.c_str());
  for (const std::string& remark : c.remarks) text += "note: " + remark + "\n";
  return text;
}

std::string yamlOf(const Calibration& c, const std::string& source) {
  if (!anyDetermined(c)) return {};
  std::string text = std::string(kYamlBegins) + " " + source + ":\n";
  text +=
      format("# %.1f s, %zu blows, residuals %.3f of their deviation.\n", c.seconds, c.blows, std::sqrt(c.mean_square));
  for (const std::string& remark : c.remarks) text += "# " + remark + "\n";
  for (const Estimate& e : c.estimates) {
    const bool whole = e.unit.empty() && e.value == std::round(e.value);
    const std::string value = whole ? format("%.0f", e.value) : numberText(e.value);
    const std::string comment =
        format("%s%s+- %.2g; %s", e.unit.empty() ? "" : ("[" + e.unit + "] ").c_str(),
               e.unit == "rad" ? format("%.4g deg ", e.value / kDegree).c_str() : "", e.deviation, e.meaning.c_str());
    if (e.determined()) {
      text += e.key + ": " + value + "  # " + comment + "\n";
      if (e.key == "crank_zero_rad")
        text += "crank_zero_std_rad: " + numberText(e.deviation) + "  # [rad] its standard deviation\n";
    } else {
      text += format("# %s is not determined: +- %.2g, limit %.2g\n", e.key.c_str(), e.deviation, e.limit);
    }
  }
  return text;
}

std::string svgOf(const Calibration& c) {
  constexpr double kBetween = 50.0, kTop = 70.0, kBottom = 50.0;  // Numerical: kBetween, kTop, kBottom
  const ResidualPanel before{kTop, c.before, "with the parameters in force", "#c0392b"};
  const ResidualPanel after{kTop + ResidualPanel::kHeight + kBetween, c.after, "with the values found", "#1f5fa8"};
  std::string svg = format(
      "%s xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" font-family=\"sans-serif\" "
      "font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
      "<text x=\"%.0f\" y=\"24\" font-size=\"16\">Mean residual of the crank angle over a revolution, %zu "
      "blows</text>\n",
      kSvgBegins, ResidualPanel::kRight + 20.0, after.top + ResidualPanel::kHeight + kBottom, ResidualPanel::kLeft,
      c.blows);
  svg += svgOf(before) + svgOf(after);
  svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">crank angle from the blow [deg]</text>\n",
                ResidualPanel::x(0.5), after.top + ResidualPanel::kHeight + 40.0);
  return svg + "</svg>\n";
}

}  // namespace hammer_loads::calibration
