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

/// Returns the impulse over [from, to] due to motion relative to the hull: minus the change of momentum of links and
/// drive. Jumps at the blow are excluded (they belong to the blow, in RockerBlow). Without quadrature the sum over any
/// division of a time is the same.
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

/// Returns the impulse over [from, to] due to weight and motion of the hull (frameWrench and the drive's part). It uses
/// Gauss-Legendre quadrature of order 6 on pieces of at most 1.25 ms that end at the blow. For a hull at rest forces
/// are exact, moments to some 1e-11 of their size.
LoadImpulse addedImpulse(const HullModel& model, const DriveReaction& drive, const CrankStep& step,
                         const HullPath& hull, double from, double to) noexcept;

/// Returns the load of links and drive over the whole step for the boom, blows included. Pieces in excess of the
/// capacity of WrenchHistory are left out (a step of several revolutions).
WrenchHistory wrenchHistory(const HullModel& model, const CrankStep& step) noexcept;

}  // namespace hammer_loads
