/// A hammer that is known exactly, for tests of what else there is to know.
#pragma once

#include <utility>

#include "hammer_loads/settings/load.h"
#include "support/held_hull.h"
#include "support/mo100.h"

namespace hammer_loads::test {

/// Without deviations, and without what level rocker leaves out.
inline Settings withExactHammer(Settings settings) {
  HammerParameters p = settings.mechanism.parameters();
  p.deviations = {};
  p.rod_std = {};
  p.crank_mass = p.crank_inertia_about_com = p.rod_mass = p.rod_inertia_about_com = 0.0;
  settings.mechanism = mechanismOf(p);
  return heldHull(std::move(settings));
}

}  // namespace hammer_loads::test
