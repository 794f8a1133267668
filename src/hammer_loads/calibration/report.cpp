#include "hammer_loads/calibration/report.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

/// With the same in degrees where it is an angle.
std::string shown(double value, const std::string& unit) {
  std::string text = format("%.6g", value);
  if (!unit.empty()) text += " " + unit;
  return unit == "rad" ? text + format(" (%.4g deg)", value / kDegree) : text;
}

std::string needOf(const Calibration& c) {
  if (!std::isfinite(c.more_blows)) return "more such work does not help, the notes say why";
  const double seconds = c.blows > 0 ? c.seconds / static_cast<double>(c.blows) * c.more_blows : 0.25 * c.more_blows;
  return format("some %.0f blows, %.0f s of such work", std::ceil(c.more_blows), std::ceil(seconds));
}

/// Direction, counts and jitter any turning crank shows: they alone are no calibration.
bool anyDetermined(const Calibration& c) {
  return std::any_of(c.estimates.begin(), c.estimates.end(), [](const Estimate& e) {
    return e.determined() && e.deviation > 0.0 && e.key != "crank_timing_noise_s";
  });
}

}  // namespace

std::string textOf(const Calibration& c) {
  if (!c.problem.empty())
    return c.problem + (std::isfinite(c.more_blows) ? "; needed are " + needOf(c) : "; more such work does not help") +
           "\n";
  std::string text = format("%.1f s, %zu blows, %zu left out; %.3g samples a second%s\n", c.seconds, c.blows,
                            c.left_out, 1.0 / c.facts.period, c.facts.retimed ? ", re-timed" : "");
  for (const Estimate& e : c.estimates) {
    text += format("%-34s %s +- %.2g, limit %.2g%s; %s\n", e.key.c_str(), shown(e.value, e.unit).c_str(), e.deviation,
                   e.limit, e.determined() ? "" : ": NOT DETERMINED, not written", e.meaning.c_str());
  }
  for (const Correlation& r : c.correlations)
    text += format("strong correlation %+.3f: %s and %s\n", r.value, r.first.c_str(), r.second.c_str());
  text += format(
      "residuals over their deviation (1: nothing but noise): first three quarters %.3f, last quarter with "
      "their values %.3f\n",
      std::sqrt(c.fitted), std::sqrt(c.held_out));
  for (const std::string& remark : c.remarks) text += "note: " + remark + "\n";
  const bool all =
      std::all_of(c.estimates.begin(), c.estimates.end(), [](const Estimate& e) { return e.determined(); });
  if (!all) text += "for every key: " + needOf(c) + "\n";
  return text;
}

std::string yamlOf(const Calibration& c, const std::string& source) {
  if (!anyDetermined(c)) return {};
  std::string text = std::string(kYamlBegins) + " " + source + ":\n";
  text += format(
      "# %.1f s, %zu blows, residuals %.3f of their deviation, %.3f in the last quarter with the values of the "
      "first three.\n",
      c.seconds, c.blows, std::sqrt(c.fitted), std::sqrt(c.held_out));
  for (const std::string& remark : c.remarks) text += "# " + remark + "\n";
  for (const Correlation& r : c.correlations)
    text += format("# strong correlation %+.3f: %s and %s\n", r.value, r.first.c_str(), r.second.c_str());
  for (const Estimate& e : c.estimates) {
    const bool whole = e.unit.empty() && e.value == std::round(e.value);
    const std::string value = whole ? format("%.0f", e.value) : numberText(e.value);
    const std::string comment =
        format("%s%s+- %.2g; %s", e.unit.empty() ? "" : ("[" + e.unit + "] ").c_str(),
               e.unit == "rad" ? format("%.4g deg ", e.value / kDegree).c_str() : "", e.deviation, e.meaning.c_str());
    if (e.determined()) {
      text += e.key + ": " + value + "  # " + comment + "\n";
    } else {
      text += format("# %s is not determined: +- %.2g, limit %.2g\n", e.key.c_str(), e.deviation, e.limit);
    }
  }
  return text;
}

std::string svgOf(const Calibration& c) {
  constexpr double kWidth = 760.0, kHeight = 420.0, kLeft = 70.0, kRight = 20.0, kTop = 50.0, kBottom = 50.0;
  double largest = 0.01 * kDegree;
  for (const ResidualCurve* curve : {&c.before, &c.after}) {
    for (std::size_t i = 0; i < curve->mean.size(); ++i) {
      if (std::isfinite(curve->mean[i]))
        largest = std::max(largest, std::abs(curve->mean[i]) + 2.0 * curve->deviation[i]);
    }
  }
  largest *= 1.05;
  const auto x = [&](double part) { return kLeft + (kWidth - kLeft - kRight) * part; };
  const auto y = [&](double value) { return kTop + (kHeight - kTop - kBottom) * 0.5 * (1.0 - value / largest); };
  std::string svg = format(
      "%s xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" font-family=\"sans-serif\" "
      "font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
      kSvgBegins, kWidth, kHeight);
  svg += format(
      "<text x=\"%.0f\" y=\"24\" font-size=\"16\">Mean residual of the crank angle over a turn, %zu blows</text>\n",
      kLeft, c.blows);
  for (int degree = -180; degree <= 180; degree += 60) {
    const double at = x(degree / 360.0 + 0.5);
    svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", at, kTop, at,
                  kHeight - kBottom);
    svg +=
        format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%d</text>\n", at, kHeight - kBottom + 18.0, degree);
  }
  for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const double at = y(part * largest);
    svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", kLeft, at,
                  kWidth - kRight, at);
    svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.3f</text>\n", kLeft - 6.0, at + 4.0,
                  part * largest / kDegree);
  }
  svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">crank angle from the blow [deg]</text>\n", x(0.5),
                kHeight - 12.0);
  svg += format("<text transform=\"translate(18 %.1f) rotate(-90)\" text-anchor=\"middle\">residual [deg]</text>\n",
                y(0.0));
  struct Curve {
    const ResidualCurve* curve;
    const char *colour, *name;
    double legend;
  };
  for (const Curve& one : {Curve{&c.before, "#c0392b", "with the parameters in force", kLeft},
                           Curve{&c.after, "#1f5fa8", "with those found", kLeft + 240.0}}) {
    std::string points;
    const auto n = static_cast<double>(one.curve->mean.size());
    for (std::size_t i = 0; i < one.curve->mean.size(); ++i) {
      const double mean = one.curve->mean[i], deviation = one.curve->deviation[i];
      if (!std::isfinite(mean)) continue;
      const double at = x((static_cast<double>(i) + 0.5) / n);
      points += format("%.1f,%.1f ", at, y(mean));
      svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-opacity=\"0.35\"/>\n",
                    at, y(mean - 2.0 * deviation), at, y(mean + 2.0 * deviation), one.colour);
    }
    svg += "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" + std::string(one.colour) + "\" points=\"" +
           points + "\"/>\n";
    svg += format("<text x=\"%.0f\" y=\"42\" fill=\"%s\">%s (bars: two deviations)</text>\n", one.legend, one.colour,
                  one.name);
  }
  return svg + "</svg>\n";
}

}  // namespace hammer_loads::calibration
