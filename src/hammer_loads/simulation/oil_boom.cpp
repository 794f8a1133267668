#include "hammer_loads/simulation/oil_boom.h"

#include <algorithm>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

double areaOf(double diameter) { return 0.25 * kPi * diameter * diameter; }

constexpr double kAmbient = 1.013e5;      // [Pa]
constexpr double kExponent = 1.0 / 1.4;   // exponent of isentropic air
constexpr double kLeastPressure = 1.0e3;  // absolute [Pa]; the oil boils below it
constexpr int kIterations = 8;            // Newton's iterations; six suffice from 0.02 to 40 MPa

}  // namespace

double OilCylinder::length(double angle) const { return std::abs(pins(angle).rod - base); }

/// The guide is free of moment at its pivot, so that the coupler's moment about it equals the rod's.
OilCylinder::Pins OilCylinder::pins(double angle) const {
  const PlanePoint driven = turnedBy(angle) * rod;
  if (linkage.guide == 0.0) {
    const PlanePoint push = (driven - base) / std::abs(driven - base);
    return {driven, -push, 0.0, push};
  }
  const PlanePoint across = driven - linkage.pivot;
  const double g = linkage.guide, c = linkage.coupler, d = std::abs(across);
  const double at_pivot = std::acos((g * g + d * d - c * c) / (2.0 * g * d));
  const PlanePoint guide = g * across / d * turnedBy(linkage.side * at_pivot), pin = linkage.pivot + guide;
  const PlanePoint push = (pin - base) / std::abs(pin - base), along = (driven - pin) / c;
  const PlanePoint by_coupler = momentOf(guide, push) / momentOf(guide, along) * along;
  return {pin, -push, push - by_coupler, by_coupler};
}

/// Follows from the virtual work of the force on the driven link.
double OilCylinder::arm(double angle) const { return momentOf(turnedBy(angle) * rod, pins(angle).on_driven); }

double OilCylinder::boreShare(double angle) const {
  return bore_area / (bore_hose + bore_area * (length(angle) - closed_length));
}

double OilCylinder::rodShare(double angle) const {
  return rod_area / (rod_hose + rod_area * (closed_length + stroke - length(angle)));
}

OilBoom oilBoomEo2621() {
  OilBoom b;
  const PlanePoint bracket(0.03, -0.06), hull(0.10 - 0.08, -0.55 + 0.05),
      both = (50.0 * bracket + 350.0 * hull) / 400.0;
  b.links[0] = {{2.60, 0.0}, {1.20, 0.08}, 400.0, 229.4};
  b.links[1] = {{1.70, 0.0}, {0.70, 0.06}, 230.0, 86.03};
  b.links[2] = {
      {0.10, -0.55}, both, 400.0, 1.104 + 29.9 + 50.0 * std::norm(bracket - both) + 350.0 * std::norm(hull - both)};
  const auto cylinder = [](PlanePoint base, PlanePoint rod, double bore, double rod_diameter, double closed,
                           double stroke, double hose) {
    return OilCylinder{base, rod, areaOf(bore), areaOf(bore) - areaOf(rod_diameter), closed, stroke, hose, hose, {}};
  };
  const PlanePoint foot(0.25, 0.40);
  b.cylinders[0] = cylinder(PlanePoint(0.138, -0.159) - foot, {0.90, -0.10}, 0.110, 0.063, 0.79, 0.65, 0.0008);
  b.cylinders[1] =
      cylinder(PlanePoint(1.30, 0.30) - b.links[0].to_next, {-0.371, 0.197}, 0.100, 0.056, 1.00, 0.73, 0.0010);
  b.cylinders[2] =
      cylinder(PlanePoint(0.35, 0.28) - b.links[1].to_next, {0.25, 0.13}, 0.080, 0.050, 0.84, 0.53, 0.0012);
  b.cylinders[2].linkage = {PlanePoint(1.44, 0.05) - b.links[1].to_next, 0.34, 0.31, -1.0};
  b.cuts = {{{0, {0.50, 0.08}, {{}, {1.482, 0.08}, 308.7, 114.3}},
             {0, {1.10, 0.08}, {{}, {1.813, 0.08}, 208.2, 40.3}},
             {1, {0.80, 0.06}, {{}, {1.255, 0.06}, 101.6, 7.42}}}};
  b.foot = {-0.1975, -0.36};
  b.bulk_modulus = 1.0e9;
  return b;
}

double ChamberOil::volume(double absolute) const noexcept {
  return (1.0 - air_) * (1.0 - (absolute - kAmbient) / bulk_modulus_) + air_ * std::pow(kAmbient / absolute, kExponent);
}

double ChamberOil::slope(double absolute) const noexcept {
  return -(1.0 - air_) / bulk_modulus_ - air_ * kExponent * std::pow(kAmbient / absolute, kExponent) / absolute;
}

double ChamberOil::bulkModulus(double pressure) const noexcept {
  const double absolute = std::max(kLeastPressure, pressure + kAmbient);
  return -volume(absolute) / slope(absolute);
}

/// The volume is convex in the pressure, so that Newton's method from below does not overshoot.
double ChamberOil::compressed(double pressure, double part) const noexcept {
  const double before = std::max(kLeastPressure, pressure + kAmbient), target = volume(before) * (1.0 - part);
  double absolute = before;
  for (int i = 0; i < kIterations; ++i) {
    const double step = (target - volume(absolute)) / slope(absolute);
    absolute = std::max({kLeastPressure, 0.1 * absolute, absolute + step});
    if (std::abs(step) < 1e-9 * absolute) break;
  }
  return absolute - kAmbient;
}

}  // namespace hammer_loads::simulation
