/// The grapple's drive: slider G - rod GH - rocker O1H, a dyad with one closed form.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/grapple/vectors.h"

namespace hammer_loads {

struct GrappleParameters;

/// The drive at one slider position.
struct DriveMotion {
  Planar o1h;         ///< from O1 to H [m]
  double dtheta1{};   ///< dtheta1/ds of rocker 1 [rad/m]
  double ddtheta1{};  ///< d2theta1/ds2 [rad/m2]
};

/// Slider positions that one assembly of the dyad reaches [m]; at both ends O1, H and G are in line (dead centres).
struct Reach {
  double low{};
  double high{};
};

/// Massless, without joint clearance: only positions matter.
class SliderDrive {
 public:
  /// Needs finite values with o1h > 0, gh > 0, drive_sign = +-1 (Grapple::make checks them).
  explicit SliderDrive(const GrappleParameters& parameters);

  /// Nothing where the triangle G-H-O1 does not close or is flat. Relative error of o1h some 1e-16; of the derivatives
  /// as well, also beside the dead centres (Heron's product instead of arccos).
  std::optional<DriveMotion> at(double slider) const noexcept;

  /// The interval without dead centre around a slider position; nothing if the slider is out of reach.
  std::optional<Reach> reachAround(double slider) const noexcept;

  /// Direction of O1A [rad], continuous within one interval of reach. Precondition: at(slider) has a value.
  double theta1(double slider) const noexcept;

  /// Both slider positions [m] with rocker 1 at theta1 [rad]; both may belong to the other assembly. NaN: none.
  std::array<double, 2> slidersAt(double theta1) const noexcept;

 private:
  Planar o1_;
  double slider_x_, o1h_, gh_, ho1a_, sign_;
};

}  // namespace hammer_loads
