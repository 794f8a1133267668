/// Levels of detail of the mechanism's model.
#pragma once

namespace hammer_loads {

/// From poor to rich. Each level's own header lists what it neglects; linkage equals rocker in the limit of vanishing
/// crank and rod masses, pulse keeps the peak and the last lobe's impulse of rocker at constant crank speed.
enum class Level {
  kPulse,    ///< P0 (15): half-sine in crank angle (hammer/hull_model.h); elsewhere treated as kRocker
  kRocker,   ///< P0: crank and rod massless; rocker mass, inertia and weight
  kLinkage,  ///< crank and rod with mass, centre of mass and inertia as well
  kElastic,  ///< an elastic rod as well (linkage/two_bodies.h); kLinkage where its stiffness is not known
};

/// A level's name where nothing but the crank's motion is given.
constexpr Level rigid(Level level) noexcept { return level == Level::kElastic ? Level::kLinkage : level; }

}  // namespace hammer_loads
