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
                                        Gravity gravity, const NearBlow& near_blow) noexcept {
  const LinkMotion l = linkMotion(mechanism.linkage(), crank.angle);
  if (level != Level::kLinkage) {
    return {hullWrenchRocker(mechanism, l.rocker, crank, gravity),
            pinForcesRocker(mechanism, l, crank, gravity, near_blow)};
  }
  return {hullWrenchLinkage(mechanism, l, crank, gravity), pinForcesLinkage(mechanism, l, crank, gravity, near_blow)};
}

}  // namespace hammer_loads
