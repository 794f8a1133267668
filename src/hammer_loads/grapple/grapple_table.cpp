#include "hammer_loads/grapple/grapple_table.h"

#include <utility>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

std::optional<std::string> printRows(const Grapple& grapple, double from, double to, int steps, std::ostream& out) {
  out << "s_m,x_m,y_m,dx_ds,dy_ds,d2x_ds2,d2y_ds2\n";
  std::optional<GrappleMotion> motion;
  for (int i = 0; i <= steps && out; ++i) {
    const double slider = i == 0 ? from : i == steps ? to : from + (to - from) * i / steps;
    motion = motion ? grapple.follow(*motion, slider) : grapple.at(slider);
    if (!motion) return grapple.explain(SliderRefusal::kNotFound, slider);
    const GrappleMotion& m = *motion;
    out << format("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", m.slider + 0.0, m.p.re, m.p.im, m.dp.re, m.dp.im,
                  m.ddp.re, m.ddp.im);
  }
  return std::nullopt;
}

/// The design figures with the limits of the working branch.
std::string designSummary(const Grapple& grapple, const DesignFigures& f) {
  std::string text;
  const auto number = [&text](const char* key, double value) { text += format("%s: %.12g\n", key, value + 0.0); };
  number("slider_closed_m", f.slider_closed);
  number("slider_open_m", f.slider_open);
  number("opening_m", f.opening);
  number("jaw_travel_m", f.jaw_travel);
  number("path_length_m", f.path_length);
  number("scoop_height_m", f.scoop_height);
  number("line_height_m", f.line_height);
  number("straight_share_within_1_5pct", f.straight_share_band);
  number("straight_share_within_3pct", f.straight_share_off);
  number("deviation_first_80pct", f.deviation_first_80);
  number("deviation_whole", f.deviation_whole);
  for (const auto& [name, limit] :
       {std::pair<const char*, const SliderLimit&>{"lower", grapple.lowerLimit()}, {"upper", grapple.upperLimit()}}) {
    text += format("%s_limit_m: %.12g\n%s_limit_kind: %s\n", name, limit.slider, name, nameOf(limit.kind));
  }
  number("least_det_J_m4", f.least_determinant.value);
  number("least_det_J_slider_m", f.least_determinant.slider);
  number("worst_condition", f.worst_condition.value);
  number("worst_condition_slider_m", f.worst_condition.slider);
  number("transmission_angle_least_deg", f.least_transmission.value / kDegree);
  number("transmission_angle_most_deg", f.most_transmission.value / kDegree);
  return text;
}

}  // namespace

std::optional<std::string> printTable(const Grapple& grapple, const TableRequest& request, std::ostream& out) {
  if (request.opening) {
    const Checked<double> slider = sliderForOpening(grapple, *request.opening);
    if (!slider.value) return "--" + slider.problems.front();
    return printRows(grapple, *slider.value, *slider.value, 0, out);
  }
  const double from = request.from.value_or(grapple.parameters().slider_closed);
  const double to = request.to.value_or(grapple.parameters().slider_open);
  for (const auto& [name, slider] : {std::pair{"--from", from}, std::pair{"--to", to}}) {
    const SliderRefusal refusal = grapple.judge(slider);
    if (refusal != SliderRefusal::kNone) return grapple.explain(refusal, slider, name);
  }
  if (!request.summary) return printRows(grapple, from, to, request.steps, out);
  out << designSummary(grapple, designFigures(grapple, from, to));
  return std::nullopt;
}

}  // namespace hammer_loads
