/// Levels of detail of the mechanism's model.
#pragma once

namespace hammer_loads {

/// Levels in the order of detail; each level's own header lists what it neglects. Linkage equals rocker for vanishing
/// crank and rod masses. Pulse keeps the peak and the last lobe's impulse of rocker at constant crank speed.
enum class Level {
  kPulse,    ///< P0 (15): half-sine in crank angle (hammer/hull_model.h); elsewhere treated as kRocker
  kRocker,   ///< P0: crank and rod massless; rocker mass, inertia and weight
  kLinkage,  ///< crank and rod with mass, centre of mass and inertia as well
  kElastic,  ///< an elastic rod as well (linkage/two_bodies.h); kLinkage where its stiffness is not known
};

/// Returns the level that applies if only the crank's motion is given.
constexpr Level rigid(Level level) noexcept { return level == Level::kElastic ? Level::kLinkage : level; }

}  // namespace hammer_loads
