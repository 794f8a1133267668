#include "hammer_loads/grapple/read_grapple.h"

#include <utility>

#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {
namespace {

struct GrappleKey {
  const char* key;
  const char* unit;
  double& (*field)(GrappleParameters&);
};

constexpr GrappleKey kGrappleKeys[] = {
    {"o1_x_m", "m", [](GrappleParameters& p) -> double& { return p.o1.re; }},
    {"o1_y_m", "m", [](GrappleParameters& p) -> double& { return p.o1.im; }},
    {"slider_line_x_m", "m", [](GrappleParameters& p) -> double& { return p.slider_x; }},
    {"o1h_length_m", "m", [](GrappleParameters& p) -> double& { return p.o1h; }},
    {"o1a_length_m", "m", [](GrappleParameters& p) -> double& { return p.o1a; }},
    {"ho1a_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.ho1a; }},
    {"gh_length_m", "m", [](GrappleParameters& p) -> double& { return p.gh; }},
    {"ab_length_m", "m", [](GrappleParameters& p) -> double& { return p.ab; }},
    {"ac_length_m", "m", [](GrappleParameters& p) -> double& { return p.ac; }},
    {"bac_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.bac; }},
    {"bd_length_m", "m", [](GrappleParameters& p) -> double& { return p.bd; }},
    {"bp_length_m", "m", [](GrappleParameters& p) -> double& { return p.bp; }},
    {"dbp_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.dbp; }},
    {"ce_length_m", "m", [](GrappleParameters& p) -> double& { return p.ce; }},
    {"od_length_m", "m", [](GrappleParameters& p) -> double& { return p.od; }},
    {"oe_length_m", "m", [](GrappleParameters& p) -> double& { return p.oe; }},
    {"doe_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.doe; }},
    {"slider_closed_m", "m", [](GrappleParameters& p) -> double& { return p.slider_closed; }},
    {"slider_open_m", "m", [](GrappleParameters& p) -> double& { return p.slider_open; }},
    {"slider_margin_m", "m", [](GrappleParameters& p) -> double& { return p.slider_margin; }},
    {"reference_slider_m", "m", [](GrappleParameters& p) -> double& { return p.reference_slider; }},
    {"reference_ab_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.reference_ab; }},
    {"reference_od_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.reference_od; }},
};

}  // namespace

std::optional<Grapple> readGrapple(ParameterReader& reader) {
  const std::size_t problems_before = reader.problems().size();
  GrappleParameters parameters;
  // Signs and what keys demand of each other are the grapple's to judge.
  for (const GrappleKey& key : kGrappleKeys)
    key.field(parameters) = reader.number(key.key, key.unit, NumberRule::any());
  parameters.drive_sign = static_cast<int>(reader.integer("drive_sign", "", -1, 1));

  Checked<Grapple> grapple = Grapple::make(parameters);
  for (const std::string& problem : grapple.problems) reader.addProblem(problem);
  if (reader.problems().size() != problems_before) return std::nullopt;
  return grapple.value;
}

Checked<Grapple> loadGrapple(const std::vector<std::string>& files) {
  Checked<Grapple> result;
  ParameterMap parameters;
  addFiles(files, parameters, result.problems);
  if (!result.problems.empty()) return result;
  ParameterReader reader(std::move(parameters));
  result.value = readGrapple(reader);
  reader.reportUnknownKeys();
  result.problems = reader.problems();
  if (!result.problems.empty()) result.value.reset();
  return result;
}

}  // namespace hammer_loads
