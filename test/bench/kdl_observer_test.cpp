#include "hammer_loads/bench/kdl_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kDuration = 4.0, kForce = 5e3, kMoment = 400.0;

/// Returns a boom at rest whose pressures, by virtual work, balance a sinusoidal load of this frequency [Hz].
simulation::Session heldBoom(const Settings& settings, double frequency) {
  const Boom& boom = *settings.boom;
  const KDL::Chain& chain = boom.chain().kdl();
  KDL::JntArray q(4), weight(4);
  q(1) = -0.4, q(2) = 1.1, q(3) = -0.6;
  KDL::ChainDynParam dynamics(chain, KDL::Vector(0.0, 0.0, -settings.pipeline.gravity));
  dynamics.JntToGravity(q, weight);
  KDL::Jacobian J(4);
  KDL::ChainJntToJacSolver(chain).JntToJac(q, J);
  KDL::Frame tip;
  KDL::ChainFkSolverPos_recursive(chain).JntToCart(q, tip);
  J.changeBase(tip.M.Inverse());
  simulation::Session session;
  const std::int64_t start = simulation::workingMo100().start_stamp;
  for (int k = 0; k <= 500 * kDuration; ++k) {
    const double time = k / 500.0, wave = std::sin(kTwoPi * frequency * time);
    const std::int64_t stamp = start + std::int64_t{2'000'000} * k;
    if (k % 10 == 0) session.joints.push_back({stamp, {q(0), q(1), q(2), q(3)}, {}});
    Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
    load[0] = 0.3 * kForce * wave, load[2] = kForce * wave, load[4] = kMoment * wave;
    const Eigen::VectorXd hold = weight.data - J.data.transpose() * load;
    simulation::PressureReading pressures{stamp, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      const Cylinder& cylinder = boom.cylinders()[i];
      const double force = hold[cylinder.joint()] / cylinder.at(q(static_cast<unsigned>(cylinder.joint()))).arm;
      (force > 0.0 ? pressures.bore : pressures.rod)[i] =
          std::abs(force) / (force > 0.0 ? cylinder.boreArea() : cylinder.rodArea());
    }
    session.pressures.push_back(pressures);
    simulation::OnBoomTruth truth{};
    truth.time = time;
    truth.load.force_x = load[0], truth.load.force_z = load[2], truth.load.torque_y = load[4];
    session.truth.push_back(truth);
    session.on_boom.push_back(truth);
  }
  return session;
}

/// A slow load on a boom at rest is reproduced, so the reference observer works under the conditions it needs. A load
/// whose angular frequency equals the observer's gain is followed with a lag.
TEST(KdlObserver, FindsASlowLoad) {
  const Settings settings = shippedBoom("{boom: compliant}");
  const auto slow = kdlErrors(heldBoom(settings, 0.5), settings, 300.0, 1.0, kDuration);
  if (!slow) GTEST_SKIP() << "KDL has no momentum observer";
  EXPECT_LT(slow->force_x.rmsOfLargest(), 0.01);
  EXPECT_LT(slow->force_z.rmsOfLargest(), 0.01);
  EXPECT_LT(slow->moment.rmsOfLargest(), 0.01);
  const auto fast = kdlErrors(heldBoom(settings, 30.0 / kTwoPi), settings, 30.0, 1.0, kDuration);
  EXPECT_NEAR(fast->force_z.rmsOfLargest(), 0.5, 0.05);  // first-order lag: the rms error is half the amplitude
}

}  // namespace
}  // namespace hammer_loads::accuracy
