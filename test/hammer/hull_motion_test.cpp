// Loads in a moving hull, compared with hull and mechanism simulated as one free system.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/hull_model.h"
#include "support/free_run.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::FreeHull;
using test::FreeRun;
using test::FreeState;

const NearBlow kNearBlow(0.01);

/// Largest difference and largest size of the reference value.
struct Error {
  double difference{}, size{};
  void add(double value, double right) {
    difference = std::max(difference, std::abs(value - right));
    size = std::max(size, std::abs(right));
  }
  double relative() const { return difference / size; }
};

class HullMotionTest : public testing::TestWithParam<Level> {
 protected:
  static FreeState thrown() {
    FreeState s;
    s.hull << 0.4, 1.3, 0.5;
    s.hull_rate << 0.8, -1.1, 1.5;
    s.crank = CrankAngle::fromAngle(0.05);
    s.crank_speed = 22.0;
    return s;
  }
  /// Runs a revolution up to just before the blow. Calls check(run, result) every millisecond.
  template <typename Check>
  static void turn(const FreeHull& system, Check check) {
    for (FreeRun run(system, thrown(), 160.0); run.blows() == 0; run.advance(1e-3)) check(run, run.result());
  }
  Mechanism mechanism_{test::mechanismOf(test::mo100LinkageParameters())};
};

TEST_P(HullMotionTest, WrenchIsWhatMovesTheFreeHull) {
  const FreeHull system(mechanism_, GetParam(), {});
  Error x, z, moment;
  turn(system, [&](const FreeRun& run, const FreeHull::Result& right) {
    const CrankMotion crank{run.state().crank, run.state().crank_speed, right.acceleration[3]};
    const HullWrench wrench = hullWrench(mechanism_, GetParam(), crank, right.hull);
    x.add(wrench.force_x, right.force_x);
    z.add(wrench.force_z, right.force_z);
    moment.add(wrench.torque_y, right.moment + right.flywheel_torque);
  });
  EXPECT_GT(z.size, 8000.0);
  EXPECT_LT(x.relative(), 1e-11);
  EXPECT_LT(z.relative(), 1e-11);
  EXPECT_LT(moment.relative(), 1e-11);
}

TEST_P(HullMotionTest, ShaftTurnsAsInTheFreeSystem) {
  const FreeHull system(mechanism_, GetParam(), {});
  ShaftModel model(mechanism_, GetParam());
  Error e, drive;
  turn(system, [&](const FreeRun& run, const FreeHull::Result& right) {
    model.setHullMotion(right.hull);
    const ShaftLoad load = model(run.state().crank);
    const ShaftState state{
        {0, run.state().crank}, run.state().crank_speed, run.torque(), mechanism_.parameters().drive_inertia};
    e.add(acceleration(load, state), right.acceleration[3]);
    drive.add(test::driveTorque(load, state.speed, right.acceleration[3]), run.torque() - right.flywheel_torque);
  });
  EXPECT_GT(e.size, 500.0);
  EXPECT_LT(e.relative(), 1e-11);
  EXPECT_LT(drive.relative(), 1e-11);
}

double cross(HullPoint arm, PinForce force) { return arm.z * force.x - arm.x * force.z; }
HullPoint operator-(HullPoint a, HullPoint b) { return {a.x - b.x, a.z - b.z}; }
PinForce operator-(PinForce a) { return {-a.x, -a.z}; }

/// The equations of Newton and Euler hold for each link by itself.
TEST_P(HullMotionTest, PinForcesMoveEveryLink) {
  const FreeHull system(mechanism_, GetParam(), {});
  const LinkLengths& lengths = mechanism_.parameters().lengths;
  const double a = mechanism_.parameters().rocker_com_angle;
  const HullPoint pin_a{lengths.pivot_distance * std::cos(a), lengths.pivot_distance * std::sin(a)};
  const auto ahead = [&](HullPoint from, double length, Planar unit) {
    return HullPoint{from.x - length * (std::cos(a) * unit.re + std::sin(a) * unit.im),
                     from.z + length * (std::cos(a) * unit.im - std::sin(a) * unit.re)};
  };
  Error force, moment;
  turn(system, [&](const FreeRun& run, const FreeHull::Result& right) {
    const CrankMotion crank{run.state().crank, run.state().crank_speed, right.acceleration[3]};
    const PinReactions pins = pinForces(mechanism_, GetParam(), crank, right.hull, kNearBlow);
    const LinkMotion l = linkMotion(mechanism_.linkage(), crank.angle);
    const HullPoint pin_b = ahead(pin_a, lengths.crank, l.phi), pin_c = ahead({}, lengths.rocker, l.psi);
    const auto demands = system.demands(run.state(), right);
    const auto check = [&](const FreeHull::Demand& link, PinForce in, HullPoint at_in, PinForce out, HullPoint at_out,
                           double couple) {
      const HullPoint com{link.com_x, link.com_z};
      const PinForce sum = in + out;
      force.add(sum.x, link.force.x);
      force.add(sum.z, link.force.z);
      moment.add(cross(at_in - com, in) + cross(at_out - com, out) + couple, link.moment);
    };
    check(demands[0], pins.hull_on_rocker, {}, pins.rod_on_rocker, pin_c, 0.0);
    if (GetParam() != Level::kLinkage) return;
    check(demands[1], pins.hull_on_crank, pin_a, -pins.crank_on_rod, pin_b, pins.drive_torque);
    check(demands[2], pins.crank_on_rod, pin_b, -pins.rod_on_rocker, pin_c, 0.0);
  });
  EXPECT_LT(force.relative(), 1e-10);
  EXPECT_LT(moment.relative(), 1e-10);
}

/// Returns the largest error of the force along the tool over its peak, if only the tilt of the hull is known.
double errorOfFixedHull(const Mechanism& mechanism, const test::HullBody& body) {
  const FreeHull system(mechanism, Level::kRocker, body);
  Error z;
  for (FreeRun run(system, test::hangingStill(body, 15.0), 160.0); run.blows() == 0; run.advance(1e-3)) {
    const FreeHull::Result right = run.result();
    const double tilt = run.state().hull[2];
    const Gravity gravity{body.gravity * std::sin(tilt), -body.gravity * std::cos(tilt)};
    const CrankMotion crank{run.state().crank, run.state().crank_speed, right.acceleration[3]};
    z.add(hullWrench(mechanism, Level::kRocker, crank, gravity).force_z, right.force_z);
  }
  EXPECT_NEAR(z.size, 8000.0, 700.0);
  return z.relative();
}

/// The ratio is 35.2/400, rocker to hull. It is larger if the hull's centre of mass is off the tool's axis through D.
TEST(MovingHull, IsWrongByTheRatioOfMassesIfTakenAsAtRest) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  test::HullBody body = test::onBoom();
  EXPECT_NEAR(errorOfFixedHull(mechanism, body), 0.138, 0.005);
  body.com_x = body.com_z = 0.0;
  body.inertia = 1e9;
  EXPECT_NEAR(errorOfFixedHull(mechanism, body), 0.088, 0.005);
  EXPECT_LT(errorOfFixedHull(mechanism, test::unmoved()), 1e-6);
}

bool sameBits(const HullWrench& a, const HullWrench& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(MovingHull, LeavesEveryLoadEqualToTheBitAtRest) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  std::mt19937 random(11);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const CrankMotion crank{CrankAngle::fromAngle(10.0 * any(random)), 40.0 * any(random), 1e3 * any(random)};
    const Gravity g{any(random), -9.8};
    const LinkMotion l = linkMotion(mechanism.linkage(), crank.angle);
    for (const HullMotion& still : {HullMotion(g), HullMotion{g, 0.0, -0.0}}) {
      const HullWrench rocker = hullWrench(mechanism, Level::kRocker, crank, still);
      EXPECT_TRUE(sameBits(rocker, hullWrenchRocker(mechanism, l.rocker, crank, g)));
      const HullWrench linkage = hullWrench(mechanism, Level::kLinkage, crank, still);
      EXPECT_TRUE(sameBits(linkage, hullWrenchLinkage(mechanism, l, crank, g)));
      const ShaftLoad load = shaftLoad(mechanism, Level::kLinkage, crank.angle, still);
      EXPECT_EQ(load.weight_torque, shaftLoadLinkage(mechanism, l, g).weight_torque);
      EXPECT_EQ(pinForces(mechanism, Level::kLinkage, crank, still, kNearBlow).drive_torque,
                pinForcesLinkage(mechanism, l, crank, g, kNearBlow).drive_torque);
    }
  }
}

/// Wrench less frameWrench is minus the momentum's rate in the hull's axes. Impulses are exact in a moving hull.
TEST_P(HullMotionTest, FrameWrenchIsAllButTheChangeOfMomentum) {
  const HullModel model(mechanism_, GetParam());
  const HullMotion hull{{4.0, -22.0}, 1.7, -60.0};
  for (const double phi : {0.5, 2.0, 3.5, 5.0, 6.0}) {
    constexpr double w = 25.0, e = 400.0, dt = 1e-6;
    const auto momentum = [&](double t) {
      return linkMomentum(model, CrankAngle::fromAngle(phi + w * t + 0.5 * e * t * t), w + e * t);
    };
    const CrankAngle angle = CrankAngle::fromAngle(phi);
    const HullWrench all = hullWrench(model, {angle, w, e}, hull), frame = frameWrench(model, angle, w, hull);
    const double size = std::hypot(all.force_x, all.force_z);
    EXPECT_NEAR(all.force_x - frame.force_x, (momentum(-dt).x - momentum(dt).x) / (2.0 * dt), 1e-6 * size);
    EXPECT_NEAR(all.force_z - frame.force_z, (momentum(-dt).z - momentum(dt).z) / (2.0 * dt), 1e-6 * size);
    const double moment = (momentum(-dt).about_d - momentum(dt).about_d) / (2.0 * dt);
    EXPECT_NEAR(all.torque_y - frame.torque_y, moment, 1e-6 * size);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, HullMotionTest, testing::Values(Level::kRocker, Level::kLinkage));

}  // namespace
}  // namespace hammer_loads
