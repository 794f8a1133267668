/// Boom, arm and hull on the oil of their cylinders, in a vertical plane: dimensions, independent of boom/.
#pragma once

#include <array>
#include <cmath>
#include <complex>

namespace hammer_loads::simulation {

/// Position in a vertical plane, x + i z [m]; a rotation by q about +y is e^(-iq).
using PlanePoint = std::complex<double>;
constexpr PlanePoint kI{0.0, 1.0};

inline PlanePoint turnedBy(double angle) { return {std::cos(angle), -std::sin(angle)}; }  ///< e^(-iq)
/// Returns the moment about +y of a force at r.
inline double momentOf(PlanePoint r, PlanePoint f) { return r.imag() * f.real() - r.real() * f.imag(); }

/// Link in its own axes, with its joint as origin.
struct OilBoomLink {
  PlanePoint to_next;  ///< next joint; of the last link: the rocker's pivot D
  PlanePoint com;
  double mass{};     ///< [kg]
  double inertia{};  ///< about the centre of mass, about y [kg m2]
};

/// Bucket linkage of a cylinder: a guide from a pivot on the previous link to the rod's pin, and a coupler from there.
struct OilLinkage {
  PlanePoint pivot;           ///< position from the joint, axes of the previous link
  double guide{}, coupler{};  ///< lengths [m]; zero: the cylinder acts directly
  double side{};              ///< 1 if the guide is rotated about +y from the line from pivot to driven pin, else -1
};

/// Cylinder of a joint. Pin positions are from the joint, base in the axes of the previous link, rod in the next one's.
struct OilCylinder {
  PlanePoint base, rod;
  double bore_area{}, rod_area{};                             ///< [m2]
  double closed_length{}, stroke{}, bore_hose{}, rod_hose{};  ///< [m], [m], [m3], [m3]
  OilLinkage linkage{};

  /// Position of the rod's end from the joint, and the forces on the chain's pins per N of the cylinder's push, in the
  /// axes of the previous link.
  struct Pins {
    PlanePoint rod;                           ///< [m]
    PlanePoint on_base, on_pivot, on_driven;  ///< [-]
  };
  Pins pins(double angle) const;

  double length(double angle) const;  ///< [m]
  double arm(double angle) const;     ///< derivative of the length by the joint's angle [m/rad]
  /// Return the change of a chamber's pressure per displacement of the rod and bulk modulus at a joint angle [1/m].
  double boreShare(double angle) const;
  double rodShare(double angle) const;
};

/// Cut across a link; beyond it x is larger in the link's axes.
struct OilBoomCut {
  std::size_t link{};
  PlanePoint place;    ///< position from the link's joint
  OilBoomLink beyond;  ///< the link's own part beyond it; to_next not used
};

/// Boom, arm and bracket with hull. The hull's mass and inertia include those of the moving links and of the rotor.
struct OilBoom {
  std::array<OilBoomLink, 3> links;
  std::array<OilCylinder, 3> cylinders;
  std::array<OilBoomCut, 3> cuts;
  PlanePoint foot;        ///< contact of hull and tool's shoulder, from D in the hull's axes
  double bulk_modulus{};  ///< [Pa]
};

/// Returns excavator EO-2621, by hand from its description and boom file; cuts in the order of the file's sections.
OilBoom oilBoomEo2621();

/// Names of the cylinders in its boom file.
constexpr std::array<const char*, 3> kBoomCylinders{"boom_cylinder", "arm_cylinder", "hammer_cylinder"};

/// Volume of oil and isentropic, undissolved air; `air` is its volume fraction at ambient pressure.
///
///     V/V_ambient = 1 - air - (1 - air) (p - ambient)/bulk + air (ambient/p)^(1/1.4)
class ChamberOil {
 public:
  ChamberOil(double bulk_modulus, double air) noexcept : bulk_modulus_(bulk_modulus), air_(air) {}

  /// Returns the bulk modulus of oil and air together at a gauge pressure [Pa].
  double bulkModulus(double pressure) const noexcept;
  /// Returns the gauge pressure [Pa] after compression from `pressure` by a part of the volume; never below a vacuum.
  double compressed(double pressure, double part) const noexcept;

 private:
  double volume(double absolute) const noexcept;  ///< relative to that at ambient pressure [-]
  double slope(double absolute) const noexcept;   ///< derivative of the volume by the pressure, negative [1/Pa]
  double bulk_modulus_, air_;
};

}  // namespace hammer_loads::simulation
