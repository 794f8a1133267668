#include "hammer_loads/pipeline/hull_deviation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/held_hull.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using simulation::MachineSettings;
using simulation::Session;

/// Part of the errors within two standard deviations: force_x, force_z, torque_y, the moment about a point elsewhere.
using Coverage = Eigen::Array4d;

const Eigen::Vector3d kElsewhere{0.3, -0.4, 1.0};  ///< moment about a point (0.4, 0.3) m away, of (Fx, Fz, My)

/// Returns the standard deviation of that moment from the deviations and correlations of a wrench.
double deviationElsewhere(const HullDeviation& deviation) {
  const Eigen::Vector3d by = kElsewhere.cwiseProduct(vectorOf(deviation.wrench())), r = deviation.correlation();
  return std::sqrt(by.squaredNorm() + 2.0 * (r[0] * by[0] * by[1] + r[1] * by[0] * by[2] + r[2] * by[1] * by[2]));
}

Coverage coverage(const MachineSettings& machine) {
  const Session session = simulation::recordSession(machine);
  const Settings settings = test::heldHull(*loadFiles(configDirectory(), {}).value);
  accuracy::SessionPlayer player(test::mechanismOf(machine.hammer), settings.pipeline, {}, session);
  Coverage inside = Coverage::Zero();
  double count = 0;
  std::size_t sample = 0;
  player.playTo(machine.drive.stop_time - 0.3, [&](double time, const SampleResult& result) {
    const simulation::CrankTruth& truth = session.truth[sample++];
    if (time < 2.0) return;
    for (const WrenchOutput& output : result.outputs) {
      Coverage error, sigma;
      error.head<3>() = vectorOf(output.wrench);
      error.head<3>() -=
          Eigen::Array3d(truth.load.force_x, truth.load.force_z, truth.load.torque_y + truth.drive_reaction_y);
      error[3] = kElsewhere.dot(error.head<3>().matrix());
      sigma << vectorOf(output.deviation.wrench()), deviationElsewhere(output.deviation);
      inside += (error.abs() <= 2.0 * sigma).cast<double>();
      ++count;
    }
  });
  return inside / count;
}

class Deviations : public testing::TestWithParam<double> {};

TEST_P(Deviations, HoldTheErrorsAsOftenAsTheyShould) {
  MachineSettings machine = simulation::workingMo100();
  machine.duration = 15.0;
  machine.drive.stop_time = 14.5;
  machine.crank.rate = GetParam();
  machine.seed = 1;
  machine.crank.drop_outs.clear();
  const Coverage inside = coverage(machine);
  for (Eigen::Index k = 0; k < inside.size(); ++k) {
    EXPECT_GE(inside[k], 0.90) << k;
    if (machine.crank.rate <= 50.0) continue;  // wider there, since lag and scale stay uncertain
    EXPECT_LE(inside[k], 0.99) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, Deviations, testing::Values(2000.0, 1000.0, 500.0, 200.0, 100.0, 50.0));

TEST(Deviations, EqualThoseOfManyDrawsForAKnownCovariance) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HullModel model(mechanism, Level::kRocker);
  CrankEstimate crank;
  crank.position.angle = CrankAngle::fromAngle(5.9);
  crank.speed = 20.0;
  crank.acceleration = -500.0;
  Eigen::Matrix3d root;
  root << 1e-4, 0, 0, 2e-3, 1e-2, 0, -0.5, 0.3, 2.0;
  const HullDeviation deviation = hullDeviation(model, {}, crank, {}, root * root.transpose());
  std::mt19937 random(1);
  std::normal_distribution<> normal;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d draw = root * Eigen::Vector3d(normal(random), normal(random), normal(random));
    CrankAngle angle = crank.position.angle;
    angle.offset += draw[0];
    const HullWrench w = hullWrench(model, {angle, crank.speed + draw[1], crank.acceleration + draw[2]}, {});
    const Eigen::Vector3d v(w.force_x, w.force_z, w.torque_y);
    sum += v;
    squares += v * v.transpose();
  }
  const Eigen::Matrix3d covariance = squares / kDraws - sum * sum.transpose() / kDraws / kDraws;
  const Eigen::Vector3d expected = covariance.diagonal().cwiseSqrt();
  EXPECT_NEAR(deviation.wrench().force_x, expected[0], 0.02 * expected[0]);  // 0.35 % by the draws, the rest curvature
  EXPECT_NEAR(deviation.wrench().force_z, expected[1], 0.02 * expected[1]);
  EXPECT_NEAR(deviation.wrench().torque_y, expected[2], 0.02 * expected[2]);
  EXPECT_NEAR(deviation.correlation()[0], covariance(0, 1) / (expected[0] * expected[1]), 0.02);
  EXPECT_NEAR(deviation.correlation()[1], covariance(0, 2) / (expected[0] * expected[2]), 0.02);
  EXPECT_NEAR(deviation.correlation()[2], covariance(1, 2) / (expected[1] * expected[2]), 0.02);
}

}  // namespace
}  // namespace hammer_loads
