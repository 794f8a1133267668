/// A straight-line grapple as its file gives it.
#pragma once

#include "hammer_loads/grapple/vectors.h"

namespace hammer_loads {

/// One jaw's linkage after Gebel 2017: slider G - rod GH - rocker H-O1-A - lever A-B-C - jaw B-D-P, tied by rod C-E to
/// the main rocker O-E-D. Right jaw in the grapple frame (planar.h); the left jaw is its mirror image in x = 0.
struct GrappleParameters {
  Planar o1{0.0, 0.0};        ///< pivot O1 of rocker 1 [m]
  double slider_x{};          ///< line on which G slides: x = slider_x [m]
  double o1h{};               ///< |O1H| [m], > 0
  double o1a{};               ///< |O1A| [m], > 0
  double ho1a{};              ///< direction of O1H minus direction of O1A [rad]
  double gh{};                ///< |GH| [m], > 0
  int drive_sign{};           ///< +1: O1H lies to the left of O1G (counter-clockwise), -1: to the right
  double ab{};                ///< |AB| [m], > 0
  double ac{};                ///< |AC| [m], > 0
  double bac{};               ///< direction of AC minus direction of AB [rad]
  double bd{};                ///< |BD| [m], > 0
  double bp{};                ///< |BP| [m], > 0
  double dbp{};               ///< direction of BP minus direction of BD [rad]
  double ce{};                ///< |CE| [m], > 0
  double od{};                ///< |OD| [m], > 0
  double oe{};                ///< |OE| [m], > 0
  double doe{};               ///< direction of OE minus direction of OD [rad]
  double slider_closed{};     ///< G.y with the jaws closed [m]
  double slider_open{};       ///< G.y with the jaws open [m]
  double slider_margin{};     ///< by how much a measured slider may overshoot the stroke [m], >= 0
  double reference_slider{};  ///< G.y of a pose on the working branch [m]
  double reference_ab{};      ///< direction of AB there, to 0.05 rad [rad]
  double reference_od{};      ///< direction of OD there, to 0.05 rad [rad]
};

/// A number of the grapple file.
struct GrappleKey {
  enum class Range { kAny, kNotNegative, kPositive };

  const char* key;
  const char* unit;
  double& (*of)(GrappleParameters&);
  Range range{Range::kAny};
};

/// All keys of the grapple file but drive_sign.
inline constexpr GrappleKey kGrappleKeys[] = {
    {"o1_x_m", "m", [](GrappleParameters& p) -> double& { return p.o1.re; }},
    {"o1_y_m", "m", [](GrappleParameters& p) -> double& { return p.o1.im; }},
    {"slider_line_x_m", "m", [](GrappleParameters& p) -> double& { return p.slider_x; }},
    {"o1h_length_m", "m", [](GrappleParameters& p) -> double& { return p.o1h; }, GrappleKey::Range::kPositive},
    {"o1a_length_m", "m", [](GrappleParameters& p) -> double& { return p.o1a; }, GrappleKey::Range::kPositive},
    {"ho1a_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.ho1a; }},
    {"gh_length_m", "m", [](GrappleParameters& p) -> double& { return p.gh; }, GrappleKey::Range::kPositive},
    {"ab_length_m", "m", [](GrappleParameters& p) -> double& { return p.ab; }, GrappleKey::Range::kPositive},
    {"ac_length_m", "m", [](GrappleParameters& p) -> double& { return p.ac; }, GrappleKey::Range::kPositive},
    {"bac_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.bac; }},
    {"bd_length_m", "m", [](GrappleParameters& p) -> double& { return p.bd; }, GrappleKey::Range::kPositive},
    {"bp_length_m", "m", [](GrappleParameters& p) -> double& { return p.bp; }, GrappleKey::Range::kPositive},
    {"dbp_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.dbp; }},
    {"ce_length_m", "m", [](GrappleParameters& p) -> double& { return p.ce; }, GrappleKey::Range::kPositive},
    {"od_length_m", "m", [](GrappleParameters& p) -> double& { return p.od; }, GrappleKey::Range::kPositive},
    {"oe_length_m", "m", [](GrappleParameters& p) -> double& { return p.oe; }, GrappleKey::Range::kPositive},
    {"doe_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.doe; }},
    {"slider_closed_m", "m", [](GrappleParameters& p) -> double& { return p.slider_closed; }},
    {"slider_open_m", "m", [](GrappleParameters& p) -> double& { return p.slider_open; }},
    {"slider_margin_m", "m", [](GrappleParameters& p) -> double& { return p.slider_margin; },
     GrappleKey::Range::kNotNegative},
    {"reference_slider_m", "m", [](GrappleParameters& p) -> double& { return p.reference_slider; }},
    {"reference_ab_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.reference_ab; }},
    {"reference_od_angle_rad", "rad", [](GrappleParameters& p) -> double& { return p.reference_od; }},
};

}  // namespace hammer_loads
