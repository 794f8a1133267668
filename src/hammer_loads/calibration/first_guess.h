/// Rough estimate of the blow's place and of the drive's inertia, from the crank's energy over the revolution.
#pragma once

#include <optional>

#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/calibration/segment_fit.h"

namespace hammer_loads::calibration {

struct FirstGuess {
  double zero{};           ///< in `seen`, within some 3 deg [rad]
  double drive_inertia{};  ///< [kg m2]
};

/// Searches the zero over the turn and the inertia about the given one: with the right values the energy (Jc + J) w^2/2
/// grows linearly from blow to blow. Empty if the crank hardly turns.
std::optional<FirstGuess> firstGuess(const CrankTrack& track, const SegmentModel& model, double drive_inertia);

}  // namespace hammer_loads::calibration
