/// Load of the moving links on a hull whose mass includes them at their mean places.
#pragma once

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {

/// A robot description's hull includes the mass and the inertia of the moving links at the mean of their places over a
/// turn. This is the difference: their weight and their inertia in the hull's motion (frameWrench) at their actual
/// places, less the same at the mean places. Refers to the model, which must outlive it.
class DisplacedLinks {
 public:
  explicit DisplacedLinks(const HullModel& model);

  /// ON the hull about D, axes of hammer_hull. No allocation.
  HullWrench wrench(const LinkMotion& links, double crank_speed, const HullMotion& hull) const noexcept;

 private:
  const HullModel* model_;
  HullWrench by_gravity_x_, by_gravity_z_;  ///< mean over a turn per gravity [kg, kg m]
  HullWrench by_acceleration_, by_square_;  ///< and per turning acceleration and square of the rate [kg m, kg m2]
};

}  // namespace hammer_loads
