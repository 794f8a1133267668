/// Pose of the grapple's links at one slider position, and their motion with it.
#pragma once

#include "hammer_loads/grapple/vectors.h"

namespace hammer_loads {

/// Derivatives of a link's direction by the slider position s.
struct TurnBySlider {
  double d{};   ///< [rad/m]
  double dd{};  ///< [rad/m2]
};

/// Right jaw, grapple frame. Relative error of positions some 1e-15, of first derivatives 1e-14, of second 1e-13 in mid
/// stroke; all grow with 1/det J towards a fold (measured: test/grapple/motion_test.cpp).
struct GrappleMotion {
  double slider{};                        ///< s = G.y [m]
  Planar g, h, a, b, c, d, e;             ///< pins [m]
  Planar p;                               ///< jaw edge P [m]
  Planar dp, ddp;                         ///< dP/ds [-], d2P/ds2 [1/m]
  double theta2{}, theta5{};              ///< directions of AB and OD, unwrapped along the branch [rad]
  TurnBySlider link1, link2, jaw, link5;  ///< H-O1-A, A-B-C, B-D-P, O-E-D
  double determinant{};                   ///< det J of the lever group [m4]; zero in a fold
};

/// Slider as measured or demanded.
struct SliderMotion {
  double position{};      ///< [m]
  double velocity{};      ///< [m/s]
  double acceleration{};  ///< [m/s2]
};

/// One jaw in time.
struct JawMotion {
  Planar edge;                    ///< P [m]
  Planar edge_velocity;           ///< [m/s]
  Planar edge_acceleration;       ///< [m/s2]
  double turning_speed{};         ///< [rad/s], counter-clockwise
  double turning_acceleration{};  ///< [rad/s2]
};

inline JawMotion rightJaw(const GrappleMotion& m, double velocity, double acceleration) noexcept {
  const double vv = velocity * velocity;
  return {m.p, velocity * m.dp, vv * m.ddp + acceleration * m.dp, velocity * m.jaw.d,
          vv * m.jaw.dd + acceleration * m.jaw.d};
}

/// Mirror image of the right jaw.
inline JawMotion leftJaw(const JawMotion& right) noexcept {
  return {mirrored(right.edge), mirrored(right.edge_velocity), mirrored(right.edge_acceleration), -right.turning_speed,
          -right.turning_acceleration};
}

/// Direction of a link's first side from +x and its derivative by s.
struct LinkDirection {
  double angle{};  ///< [rad], in [-pi, pi]
  double d{};      ///< [rad/m]
};

}  // namespace hammer_loads
