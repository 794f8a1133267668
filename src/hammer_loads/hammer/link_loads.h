/// Hull wrench and pin forces of one state from one evaluation of the motion.
#pragma once

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads {

struct LinkLoads {
  HullWrench wrench;
  PinReactions pins;
};

/// Level pulse: as rocker. No allocation, no failure for finite input.
HAMMER_LOADS_INLINE LinkLoads linkLoads(const Mechanism& mechanism, Level level, const CrankMotion& crank,
                                        const HullMotion& hull, const NearBlow& near_blow) noexcept {
  const LinkMotion l = linkMotion(mechanism.linkage(), crank.angle);
  return {
      level == Level::kLinkage ? hullWrench(mechanism, l, crank, hull) : hullWrench(mechanism, l.rocker, crank, hull),
      pinForces(mechanism, level, l, crank, hull, near_blow)};
}

}  // namespace hammer_loads
