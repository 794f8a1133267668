// Vibration of the shipped boom: forces of its cylinders, energy, response of the hull.
#include "hammer_loads/boom/vibration.h"

#include <gtest/gtest.h>

#include "boom/shipped_boom.h"
#include "hammer_loads/boom/load_errors.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

using test::kZero;
using test::ShippedBoom;

TEST_F(ShippedBoom, StandsWhereTheVibrationTakesIt) {
  const JointVector torque = boom_.hammerTorque(push_);
  for (int i = 0; i < 40; ++i) steadyLoad(1e-3, torque);
  const JointVector q = test::workingPosition(), x = vibration().displacement() + 1e-3 * vibration().velocity();
  ASSERT_GT(x.norm(), 1e-3);
  ASSERT_LT(x.norm(), 0.1);
  boom_.moveVibrating({q, kZero, kZero}, boom_.vibration().displacementAfter(1e-3), test::kLevel);
  ChainPose there;
  forwardKinematics(boom_.chain(), q + x, there);
  EXPECT_LT((boom_.pose().tip().matrix() - there.tip().matrix()).norm(), 1e-12);
  // Cylinder and steel loads use the same moment arms and the same velocities.
  BoomLoads loads;
  SteelLoads steel;
  ASSERT_TRUE(boom_.loads(push_, false, loads) && boom_.steelLoads(push_, false, steel));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(steel.pins[i].base.norm(), std::abs(loads.cylinder[i].force), 1e-9 * steel.pins[i].base.norm());
  // A displacement that is no longer a small vibration moves no link.
  for (int i = 0; i < 100; ++i) steadyLoad(1e-3, 100.0 * torque);
  ASSERT_GT(vibration().displacement().norm(), 0.2);
  boom_.moveVibrating({q, kZero, kZero}, boom_.vibration().displacementAfter(1e-3), test::kLevel);
  forwardKinematics(boom_.chain(), q, there);
  EXPECT_LT((boom_.pose().tip().matrix() - there.tip().matrix()).norm(), 1e-12);
}

TEST_F(ShippedBoom, CylindersCarryWhatTheyHold) {
  // hammer + vibration = K x + C x' of the joints that have a cylinder.
  const JointVector from = boom_.hammerTorque(push_), to = -0.3 * from;
  vibration().advance(0.013, {from, to, 0.5 * (from + to)});
  const BoomModes& m = modes();
  const Eigen::Vector3d x = vibration().displacement().tail<3>(), v = vibration().velocity().tail<3>();
  const Eigen::Matrix3d M = m.mass.bottomRightCorner<3, 3>(), S = m.shape;
  const Eigen::Vector3d damping = 2.0 * boom_.parameters().vibration.damping_ratio * m.omega;
  const Eigen::Vector3d held = m.stiffness.cwiseProduct(x) + M * S * damping.asDiagonal() * S.transpose() * M * v;
  const JointVector carried = to + vibration().torque();
  EXPECT_LT((carried.tail<3>() - held).norm(), 1e-11 * held.norm());
  EXPECT_EQ(vibration().displacement()[0], 0.0);
  // The acceleration is the remaining torque over M. The held swing joint carries the coupling only.
  EXPECT_LT((vibration().torque() + m.mass * vibration().acceleration()).norm(), 1e-11 * held.norm());
}

TEST_F(ShippedBoom, StrikeGivesTheImpulseAsMomentum) {
  const JointVector impulse = test::joints({3.0, -20.0, 14.0, 5.0});
  vibration().strike(impulse);
  const Eigen::Vector3d momentum = modes().mass.bottomRightCorner<3, 3>() * vibration().velocity().tail<3>();
  EXPECT_LT((momentum - impulse.tail<3>()).norm(), 1e-12 * impulse.norm());
  EXPECT_TRUE(vibration().displacement().isZero(0.0));
}

TEST_F(ShippedBoom, EnergyComesBackWithThePose) {
  // A slowly moving pose changes the energy with omega. At the first pose the energy is as before (damping near 0).
  VibrationSettings settings = boom_.parameters().vibration;
  settings.damping_ratio = 1e-9;
  Vibration free(boom_.chain(), boom_.cylinders(), settings);
  free.setPose(test::workingPosition(), Eigen::Vector3d::Zero());
  free.strike(test::joints({0.0, 500.0, 0.0, 0.0}));
  const double start = free.energy();
  const double omega = free.modes().omega[0];
  double least = start, most = start, softest = omega, hardest = omega;
  constexpr int kSteps = 40000;
  for (int i = 1; i <= kSteps; ++i) {
    const double sway = 0.25 * std::sin(2.0 * kPi * i / kSteps);
    free.setPose(test::workingPosition() + test::joints({0.0, sway, -sway, 0.5 * sway}), Eigen::Vector3d::Zero());
    free.advance(1e-3, {kZero, kZero, kZero});
    least = std::min(least, free.energy()), most = std::max(most, free.energy());
    softest = std::min(softest, free.modes().omega[0]), hardest = std::max(hardest, free.modes().omega[0]);
  }
  EXPECT_NEAR(free.energy(), start, 0.02 * start);
  EXPECT_GT(least, start * softest / omega * 0.9);
  EXPECT_LT(most, start * hardest / omega * 1.1);
  EXPECT_GT(hardest / softest, 1.05);
}

TEST_F(ShippedBoom, GivesReducedMassAndStiffnessAtTheHull) {
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitZ().eval()}) {
    const ReducedHull reduced = boom_.reducedHull(direction);
    vibration().reset();
    // An impulse of 1 N s moves the hull at the velocity 1/mass along it. A steady 1 N displaces it by 1/stiffness.
    const JointVector unit = boom_.hammerTorque({direction, Eigen::Vector3d::Zero()});
    vibration().strike(unit);
    EXPECT_NEAR(direction.dot(boom_.tipVibration().velocity.head<3>()) * reduced.mass, 1.0, 1e-11);
    vibration().reset();
    for (int i = 0; i < 10; ++i) steadyLoad(5.0, unit);
    EXPECT_NEAR(direction.dot(boom_.tipVibration().displacement.head<3>()) * reduced.stiffness, 1.0, 1e-9);
    EXPECT_GT(reduced.mass, 50.0);
    EXPECT_LT(reduced.mass, 6100.0);
  }
  // No vibrating joint moves the hull sideways.
  EXPECT_TRUE(std::isinf(boom_.reducedHull(Eigen::Vector3d::UnitY()).stiffness) ||
              boom_.reducedHull(Eigen::Vector3d::UnitY()).stiffness > 1e30);
}

TEST_F(ShippedBoom, RigidErrorFollowsPulseLength) {
  const JointVector torque = boom_.hammerTorque({Eigen::Vector3d(0.0, 0.0, 8e3), Eigen::Vector3d::Zero()});
  const double zeta = boom_.parameters().vibration.damping_ratio;
  const auto error = [&](double length) { return rigidError(modes(), zeta, torque, length); };
  const double period = 2.0 * kPi / modes().omega[0];
  EXPECT_LT(error(200.0 * period), 0.01);          // slow: static
  EXPECT_NEAR(error(0.0005 * period), 1.0, 0.02);  // short: the boom hardly moves, the cylinders carry nothing
  EXPECT_GT(error(0.018), 0.5);                    // the MO-100's pulse: a rigid boom is wrong
  EXPECT_EQ(error(0.0), 0.0);
  const Wrench peak{Eigen::Vector3d(0.0, 0.0, 8e3), Eigen::Vector3d::Zero()};
  EXPECT_EQ(boom_.rigidError(peak, 0.018), error(0.018));
  EXPECT_EQ(rigidError(modes(), zeta, kZero, 0.018), 0.0);

  // The result is compared with small steps through the pulse.
  const double length = 0.05, h = length / 2000.0;
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const auto at = [&](int k) { return JointVector((k < 2000 ? std::sin(kPi * k / 2000.0) : 0.0) * torque); };
    vibration().advance(h, {at(i), at(i + 1), 0.5 * (at(i) + at(i + 1))});
    worst = std::max(worst, vibration().torque().cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(error(length), worst / torque.cwiseAbs().maxCoeff(), 0.01 * error(length));
}

}  // namespace
}  // namespace hammer_loads
