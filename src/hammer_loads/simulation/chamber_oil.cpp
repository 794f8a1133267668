#include "hammer_loads/simulation/chamber_oil.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads::simulation {
namespace {

constexpr double kAmbient = 1.013e5;      // [Pa]
constexpr double kExponent = 1.0 / 1.4;   // exponent of isentropic air
constexpr double kLeastPressure = 1.0e3;  // absolute [Pa]: oil boils
constexpr int kIterations = 8;            // Newton's iterations: from 0.02 to 40 MPa in six

}  // namespace

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

/// The volume falls ever slower with the pressure: Newton from below stays below.
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
