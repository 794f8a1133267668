/// Boom, arm and hull on the oil of their cylinders, in a vertical plane: dimensions, independent of boom/.
#pragma once

#include <array>
#include <cmath>
#include <complex>

namespace hammer_loads::simulation {

/// A place in a vertical plane, x + i z [m]; a turn by q about +y is e^(-iq).
using PlanePoint = std::complex<double>;
constexpr PlanePoint kI{0.0, 1.0};

inline PlanePoint turnedBy(double angle) { return {std::cos(angle), -std::sin(angle)}; }  ///< e^(-iq)
/// Moment about +y of a force at r.
inline double momentOf(PlanePoint r, PlanePoint f) { return r.imag() * f.real() - r.real() * f.imag(); }

/// A link from its joint on, in its own axes.
struct OilBoomLink {
  PlanePoint to_next;  ///< next joint; of the last link: the rocker's pivot D
  PlanePoint com;
  double mass{};     ///< [kg]
  double inertia{};  ///< about the centre of mass, about y [kg m2]
};

/// Bucket linkage of a cylinder: a link from a pivot on the link before to the rod's pin, another from there on.
struct OilLinkage {
  PlanePoint pivot;           ///< from the joint, axes of the link before
  double guide{}, coupler{};  ///< lengths [m]; zero: the cylinder acts directly
  double side{};              ///< 1: the guide is turned about +y from the line between pivot and driven pin; or -1
};

/// Cylinder of a joint; pins from the joint: base in the axes of the link before, rod in those of the link beyond.
struct OilCylinder {
  PlanePoint base, rod;
  double bore_area{}, rod_area{};                             ///< [m2]
  double closed_length{}, stroke{}, bore_hose{}, rod_hose{};  ///< [m], [m], [m3], [m3]
  OilLinkage linkage{};

  /// Place of the rod's end, and the forces on the chain's pins for each N of the cylinder's push; from the joint, axes
  /// of the link before.
  struct Pins {
    PlanePoint rod;                           ///< [m]
    PlanePoint on_base, on_pivot, on_driven;  ///< [-]
  };
  Pins pins(double angle) const;

  double length(double angle) const;  ///< [m]
  double arm(double angle) const;     ///< derivative of the length by the joint's angle [m/rad]
  /// Pressure in a chamber over the rod's way out at a place of the joint, per bulk modulus [1/m].
  double boreShare(double angle) const;
  double rodShare(double angle) const;
};

/// A cut across a link, x > 0 beyond it in the link's axes.
struct OilBoomCut {
  std::size_t link{};
  PlanePoint place;    ///< from the link's joint
  OilBoomLink beyond;  ///< the link's own part beyond it; to_next not used
};

/// Boom, arm, bracket with hull; the hull's mass and inertia include those of the moving links and of the rotor.
struct OilBoom {
  std::array<OilBoomLink, 3> links;
  std::array<OilCylinder, 3> cylinders;
  std::array<OilBoomCut, 3> cuts;
  PlanePoint foot;        ///< contact of hull and tool's shoulder, from D in the hull's axes
  double bulk_modulus{};  ///< [Pa]
};

/// Excavator EO-2621; figures by hand from its description and boom file, cuts in the order of the file's sections.
OilBoom oilBoomEo2621();

/// Names of the cylinders in its boom file.
constexpr std::array<const char*, 3> kBoomCylinders{"boom_cylinder", "arm_cylinder", "hammer_cylinder"};

/// A volume of oil and air; air: its share of the volume at ambient pressure. Isentropic air, nothing of it dissolves.
///
///     V/V_ambient = 1 - air - (1 - air) (p - ambient)/bulk + air (ambient/p)^(1/1.4)
class ChamberOil {
 public:
  ChamberOil(double bulk_modulus, double air) noexcept : bulk_modulus_(bulk_modulus), air_(air) {}

  /// Bulk modulus of oil and air together at a gauge pressure [Pa].
  double bulkModulus(double pressure) const noexcept;
  /// Gauge [Pa], of a volume that was at `pressure` and is compressed by a part of itself; never below a vacuum.
  double compressed(double pressure, double part) const noexcept;

 private:
  double volume(double absolute) const noexcept;  ///< over that at ambient pressure
  double slope(double absolute) const noexcept;   ///< derivative of the volume by the pressure, negative [1/Pa]
  double bulk_modulus_, air_;
};

}  // namespace hammer_loads::simulation
