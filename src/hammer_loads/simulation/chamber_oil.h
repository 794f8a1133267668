/// Oil in a cylinder's chamber, with air in it.
#pragma once

namespace hammer_loads::simulation {

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
