#include "hammer_loads/hammer/displaced_links.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "hammer_loads/simulation/moving_links.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr int kPlaces = 5000;  // crank angles of a revolution

/// Links as bodies in a moving hull, by Newton's law. Their places are from the simulated machine's linkage.
class Bodies {
 public:
  Bodies(const Mechanism& mechanism, Level level) : p_(mechanism.parameters()), links_(mechanism, level) {}

  HullWrench load(double angle, double speed, const HullMotion& hull) const {
    const simulation::TurnAngle turn{std::remainder(angle, kTwoPi), std::remainder(angle, kTwoPi) < 0.0, false};
    const simulation::LinkBodies bodies = links_.at(turn);
    HullWrench sum;
    for (int i = 0; i < bodies.count; ++i) {
      const auto& b = bodies.body[i];
      const std::array<double, 2> r = inHull(b.xi.value - p_.lengths.pivot_distance, b.eta.value);
      const std::array<double, 2> rate = inHull(speed * b.xi.first, speed * b.eta.first);
      const double a = hull.acceleration, w = hull.rate;  // a rotation about +y turns z to x
      const double x = hull.gravity.x - a * r[1] + w * w * r[0] - 2.0 * w * rate[1];
      const double z = hull.gravity.z + a * r[0] + w * w * r[1] + 2.0 * w * rate[0];
      sum.force_x += b.mass * x, sum.force_z += b.mass * z;
      sum.torque_y += b.mass * (r[1] * x - r[0] * z) - b.inertia_about_com * a;
    }
    return sum;
  }
  HullWrench mean(const HullMotion& hull) const {
    HullWrench sum;
    for (int i = 0; i < kPlaces; ++i) sum = sum + (1.0 / kPlaces) * load((i + 0.5) * kTwoPi / kPlaces, 0.0, hull);
    return sum;
  }

 private:
  std::array<double, 2> inHull(double xi, double eta) const {
    const double c = std::cos(p_.rocker_com_angle), s = std::sin(p_.rocker_com_angle);
    return {-(c * xi + s * eta), -s * xi + c * eta};
  }
  const HammerParameters& p_;
  simulation::MovingLinks links_;
};

TEST(DisplacedLinks, AreTheBodiesWhereTheyAreLessTheirMeanOverATurn) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  std::mt19937 random(3);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  double greatest = 0.0;
  for (const Level level : {Level::kRocker, Level::kLinkage}) {
    const HullModel model(mechanism, level);
    const DisplacedLinks displaced(model);
    const Bodies bodies(mechanism, level);
    for (int i = 0; i < 40; ++i) {
      const HullMotion hull{{between(-15.0, 15.0), between(-15.0, 15.0)}, between(-1.0, 1.0), between(-30.0, 30.0)};
      const double angle = between(0.01, kTwoPi - 0.01), speed = between(-35.0, 35.0);
      const HullWrench told = displaced.wrench(linksAt(model, CrankAngle::fromAngle(angle)).links, speed, hull);
      const HullWrench right = bodies.load(angle, speed, hull) + -1.0 * bodies.mean(hull);
      EXPECT_NEAR(told.force_x, right.force_x, 1e-3);
      EXPECT_NEAR(told.force_z, right.force_z, 1e-3);
      EXPECT_NEAR(told.torque_y, right.torque_y, 1e-3);
      greatest = std::max(greatest, std::abs(told.torque_y));
    }
  }
  EXPECT_GT(greatest, 30.0) << "what there is to find";
}

}  // namespace
}  // namespace hammer_loads
