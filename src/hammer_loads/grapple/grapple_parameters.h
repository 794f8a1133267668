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

}  // namespace hammer_loads
