#include "hammer_loads/hammer/displaced_links.h"

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr int kPlaces = 720;  // crank angles of a revolution

HullWrench meanOfTurn(const HullModel& model, const HullMotion& hull) {
  HullWrench mean;
  for (int i = 0; i < kPlaces; ++i)
    mean = mean + (1.0 / kPlaces) * frameWrench(model, CrankAngle::fromAngle((i + 0.5) * kTwoPi / kPlaces), 0.0, hull);
  return mean;
}

}  // namespace

DisplacedLinks::DisplacedLinks(const HullModel& model)
    : model_(&model),
      by_gravity_x_(meanOfTurn(model, Gravity{1.0, 0.0})),
      by_gravity_z_(meanOfTurn(model, Gravity{0.0, 1.0})),
      by_acceleration_(meanOfTurn(model, {{}, 0.0, 1.0})),
      by_square_(meanOfTurn(model, {{}, 1.0, 0.0})) {}

HullWrench DisplacedLinks::wrench(const LinkMotion& links, double crank_speed, const HullMotion& hull) const noexcept {
  const HullWrench held = hull.gravity.x * by_gravity_x_ + hull.gravity.z * by_gravity_z_ +
                          hull.acceleration * by_acceleration_ + hull.rate * hull.rate * by_square_;
  return frameWrench(*model_, links, crank_speed, hull) + -1.0 * held;
}

}  // namespace hammer_loads
