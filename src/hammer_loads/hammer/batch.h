/// Loads of many states at once, for studies and tables: several states per instruction, as wide as the CPU allows.
///
/// The width is chosen when the library is loaded (AVX-512, AVX with FMA, or the baseline). A state's result does not
/// depend, to the bit, on its place in the arrays nor on how they are cut; it may differ in the last digits from
/// another CPU's and from the scalar call, which node and process_bag use.
#pragma once

#include <cstddef>

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {

/// Array of `count` states; each pointer refers to an array of that length.
struct CrankStates {
  const double* angle{};  ///< crank angle from A->D [rad], any winding up to 4e8 rad; just below 0: before a blow
  const double* speed{};  ///< [rad/s]
  const double* acceleration{};  ///< [rad/s2]
  std::size_t count{};
};

/// Wrenches of the states, see HullWrench; arrays of the states' length, none overlapping another or the states.
struct WrenchArrays {
  double* force_x{};   ///< [N]
  double* force_z{};   ///< [N]
  double* torque_y{};  ///< [N m]
};

/// Pin forces of the states, see PinReactions; arrays as in the wrenches.
struct PinArrays {
  double* hull_on_crank_x{};   ///< R01 [N]
  double* hull_on_crank_z{};   ///< [N]
  double* crank_on_rod_x{};    ///< R12 [N]
  double* crank_on_rod_z{};    ///< [N]
  double* rod_on_rocker_x{};   ///< R23 [N]
  double* rod_on_rocker_z{};   ///< [N]
  double* hull_on_rocker_x{};  ///< R03 [N]
  double* hull_on_rocker_z{};  ///< [N]
  double* drive_torque{};      ///< [N m]
};

/// Hull wrenches of all states under one gravity, at the model's level. No allocation. Worst relative error next to the
/// blow: 6e-15 for MO-100, 1e-13 for a pivot distance of 1.02 crank lengths, growing as 1/(pivot distance/crank - 1);
/// the scalar call has 1e-14 for any machine (test).
void hullWrenches(const HullModel& model, const CrankStates& states, Gravity gravity,
                  const WrenchArrays& wrenches) noexcept;

/// Hull wrenches and pin forces (level pulse: both as rocker). No allocation.
void linkLoads(const HullModel& model, const CrankStates& states, Gravity gravity, const WrenchArrays& wrenches,
               const PinArrays& pins) noexcept;

}  // namespace hammer_loads
