/// Impulse of the hull wrench over a step or a part of it: exact where momentum gives it, at any output rate.
#pragma once

#include <optional>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/wrench_path.h"

namespace hammer_loads {

/// An impulse and the drive's part of its moment.
struct LoadImpulse {
  HullWrench all;    ///< [N s, N s, N m s]
  double drive_y{};  ///< [N m s]
};

/// Over [from, to], by motion relative to the hull: minus the change of the momentum of links and drive, the jumps at
/// the blow left out (they are the blow's own, in RockerBlow). No quadrature, so the sum over any division of a time is
/// the same.
LoadImpulse motionImpulse(const HullModel& model, const DriveReaction& drive, const CrankStep& step, double from,
                          double to) noexcept;

/// The hull's motion over a step: linear between its ends, with a jump at a blow.
struct HullPath {
  HullMotion from, to;
  double length{};             ///< length of the step [s]
  std::optional<double> blow;  ///< [s] after its start

  HullMotion at(double time) const noexcept {
    if (blow) return time < *blow ? from : to;
    return length > 0.0 ? blend(from, to, time / length) : to;
  }
};

/// Impulse over [from, to] of what weight and motion of the hull add (frameWrench and the drive's part). Gauss-Legendre
/// of order 6 on pieces of at most 1.25 ms that end at the blow: forces of a hull at rest exact, moments to some 1e-11
/// of their size.
LoadImpulse addedImpulse(const HullModel& model, const DriveReaction& drive, const CrankStep& step,
                         const HullPath& hull, double from, double to) noexcept;

/// The load of links and drive over the whole step for the boom, blows included. Pieces in excess of the capacity of
/// WrenchHistory are left out (a step of several turns).
WrenchHistory wrenchHistory(const HullModel& model, const CrankStep& step) noexcept;

}  // namespace hammer_loads
