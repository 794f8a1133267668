#include "hammer_loads/linkage/blow_inertia.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kDrive = 0.6;

/// Returns the mass matrix of the rates of crank, rod and rocker at the dead centre, from the links' masses and centres
/// alone. There all pins are in line, and their velocities are perpendicular to that line.
Eigen::Matrix3d massMatrix(const HammerParameters& p, Level level) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, 0) = kDrive;
  m(2, 2) = p.rocker_inertia_about_pivot;
  if (level != Level::kLinkage) return m;
  const double along = p.crank_com_along, across = p.crank_com_across;
  m(0, 0) += p.crank_inertia_about_com + p.crank_mass * (along * along + across * across);
  // The rod's centre of mass moves with l1 phi' + along beta' across the line and with -across beta' along it.
  const double l1 = p.lengths.crank, a = p.rod_com_along, b = p.rod_com_across;
  m(0, 0) += p.rod_mass * l1 * l1;
  m(0, 1) = m(1, 0) = p.rod_mass * l1 * a;
  m(1, 1) = p.rod_mass * (a * a + b * b) + p.rod_inertia_about_com;
  return m;
}

/// Returns the rates after the tool's impulse: solves M change + C' impulses = tool with the constraints C rates = 0.
Eigen::Vector3d afterImpulse(const Eigen::Matrix3d& m, const Eigen::MatrixXd& c, const Eigen::Vector3d& before,
                             const Eigen::Vector3d& tool) {
  const Eigen::Index n = c.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 + n, 3 + n);
  all.topLeftCorner(3, 3) = m;
  all.topRightCorner(3, n) = c.transpose();
  all.bottomLeftCorner(n, 3) = c;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3 + n);
  right.head(3) = m * before + tool;
  return all.fullPivLu().solve(right).head(3);
}

/// Returns the crank speed after the blow over that before, by Lagrange multipliers in all three rates.
double factorByConstraints(const Mechanism& mechanism, Level level, double restitution) {
  const LinkLengths& l = mechanism.linkage().lengths();
  const Eigen::Matrix3d m = massMatrix(mechanism.parameters(), level);
  const double u_before = motion(mechanism.linkage(), {0.0, Side::kBeforeBlow}).u;
  const double u_after = motion(mechanism.linkage(), {0.0, Side::kAfterBlow}).u;
  Eigen::MatrixXd loop(1, 3), branch(2, 3);
  loop << l.crank, l.rod, -l.rocker;
  branch << l.crank, l.rod, -l.rocker, -u_after, 0.0, 1.0;
  const Eigen::Vector3d before(1.0, (l.rocker * u_before - l.crank) / l.rod, u_before), tool(0.0, 0.0, 1.0);
  // The tool's impulse reverses the rocker. The rocker's rate is linear in it.
  const double none = afterImpulse(m, loop, before, 0.0 * tool)[2], one = afterImpulse(m, loop, before, tool)[2];
  const double impulse = (-restitution * u_before - none) / (one - none);
  const Eigen::Vector3d left_tool = afterImpulse(m, loop, before, impulse * tool);
  return afterImpulse(m, branch, left_tool, 0.0 * tool)[0];
}

TEST(BlowInertia, TakesTheCrankAlongAsTheMomentaOfAllLinksDo) {
  Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (const Level level : {Level::kRocker, Level::kLinkage}) {
    const BlowInertia b = blowInertia(mechanism, level, kDrive);
    for (const double restitution : {0.0, 0.1, 0.1753, 0.3, 0.8}) {
      const double factor = factorByConstraints(mechanism, level, restitution);
      EXPECT_NEAR(b.factor(restitution), factor, 1e-12) << restitution;
      EXPECT_NEAR(b.restitution(factor), restitution, 1e-12);
    }
  }
}

TEST(BlowInertia, MasslessLinksFollowTheContractsFormula) {
  Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const BlowInertia b = blowInertia(mechanism, Level::kRocker, kDrive);
  const double inertia = 0.737, k = 0.8, up = b.u_after, um = b.u_before;
  EXPECT_NEAR(b.restitution(k), (k * (kDrive + inertia * up * up) - kDrive) / (inertia * up * std::abs(um)), 1e-12);
  EXPECT_DOUBLE_EQ(b.smoothFactor(), 1.0);
  EXPECT_NEAR(b.restitution(1.0), 0.1753, 5e-5);  // model.md 1
  EXPECT_NEAR((b.restitution(k + 1e-6) - b.restitution(k)) / 1e-6, b.restitutionPerFactor(), 1e-8);
}

}  // namespace
}  // namespace hammer_loads
