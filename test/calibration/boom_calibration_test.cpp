// A boom weighed by its own cylinders, against machines whose equations the estimate does not share.
#include <gtest/gtest.h>

#include "calibration/free_boom.h"
#include "hammer_loads/calibration/reading_check.h"

namespace hammer_loads::calibration {
namespace {

using test::FreeBoom;

/// Joints' angles as read, of boom, arm and hammer.
JointVector posed(const FreeBoom& machine, const std::array<double, 3>& q) {
  return test::joints({0.0, q[0] + machine.zero[0], q[1] + machine.zero[1], q[2] + machine.zero[2]});
}

/// Over poses at random: per joint, rms of error over rms of torque; and how many errors are within two deviations.
struct StaticScore {
  std::array<double, 3> part{};
  int within{}, count{};
};

StaticScore scoreOf(const FreeBoom& machine, const BoomCalibration& found, std::mt19937& random) {
  BoomBasis basis = test::shippedBasis();
  StaticScore score;
  Boom boom = Boom::make(basis.urdf, found.found).value.value();
  std::array<double, 3> error{}, torque{};
  for (int i = 0; i < 20; ++i) {
    const std::array<double, 3> q{test::between(random, -0.7, 0.4), test::between(random, 0.6, 2.1),
                                  test::between(random, -1.7, -0.1)};
    JointVector as_zeroed = posed(machine, q);
    for (std::size_t k = 0; k < 3; ++k) as_zeroed[static_cast<int>(k) + 1] -= found.found.cylinders[k].joint_zero;
    boom.move({as_zeroed, test::kZero, test::kZero}, test::kLevel);
    const std::array<double, 3> truth = machine.staticTorque(q);
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = boom.steadyTorque(static_cast<int>(k) + 1) - truth[k];
      error[k] += off * off, torque[k] += truth[k] * truth[k];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) score.part[k] = std::sqrt(error[k] / torque[k]);
  return score;
}

TEST(BoomCalibration, TryOut) {
  std::mt19937 random(1);
  for (int m = 0; m < 6; ++m) {
    const FreeBoom machine = FreeBoom::drawn(random);
    const BoomCalibration c = calibrateBoom(test::shippedBasis(), {{machine.record(random, 120.0), {}}});
    std::cout << c.problem << " points " << c.points << " left out " << c.left_out << "\n";
    if (!c.problem.empty()) continue;
    const StaticScore s = scoreOf(machine, c, random);
    for (std::size_t k = 0; k < 3; ++k) {
      const CylinderFit& f = c.cylinders[k];
      const double truth = machine.friction_force[k] + machine.friction[k] * f.force;
      std::cout << f.name << " rows " << f.rows << " force " << f.force << " left " << f.left << " before " << f.before
                << " held " << f.held_out << " friction " << f.friction << "+-" << f.friction_deviation << " true "
                << truth << " | static error % " << 100 * s.part[k] << " said % " << 100 * c.joints[k].part() << " " << c.joints[k].torque << "\n";
    }
    for (const auto& e : c.estimates)
      if (m == 0) std::cout << e.key << " " << e.value << " +- " << e.deviation << " of " << e.limit << " " << e.meaning << "\n";
  }
}

}  // namespace
}  // namespace hammer_loads::calibration
