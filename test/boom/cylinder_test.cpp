#include "hammer_loads/boom/cylinder.h"

#include <gtest/gtest.h>

#include "boom/booms.h"

namespace hammer_loads {
namespace {

constexpr double kBulkModulus = 1e9;

class Cylinders : public testing::Test {
 protected:
  Cylinders() : parameters_(test::directBoomParameters()), chain_(*Chain::make(test::shippedUrdf(), {}).value) {}
  Cylinder make(const CylinderParameters& p) const {
    const Checked<Cylinder> made = Cylinder::make(p, kBulkModulus, chain_);
    if (!made.value) throw std::runtime_error(made.problems.front());
    return *made.value;
  }
  /// Returns the distance of the anchors by the chain's forward kinematics [m].
  double length(const CylinderParameters& p, double angle) const {
    JointVector q = JointVector::Zero(chain_.joints());
    const int joint = *chain_.jointIndex(p.joint);
    q[joint] = angle;
    ChainPose pose;
    forwardKinematics(chain_, q, pose);
    const Eigen::Vector3d base = pose.link(chain_.linkBeyond(joint) - 1) * Eigen::Vector3d(p.base_x, 0.0, p.base_z);
    const Eigen::Vector3d rod = pose.link(chain_.linkBeyond(joint)) * Eigen::Vector3d(p.rod_x, 0.0, p.rod_z);
    return (rod - base).norm();
  }
  double limit(const CylinderParameters& p, double share) const {
    const int joint = *chain_.jointIndex(p.joint);
    return chain_.lower()[joint] + share * (chain_.upper()[joint] - chain_.lower()[joint]);
  }

  BoomParameters parameters_;
  Chain chain_;
};

TEST_F(Cylinders, LengthIsTheDistanceOfTheAnchorsAndArmItsSlope) {
  for (const CylinderParameters& p : parameters_.cylinders) {
    const Cylinder cylinder = make(p);
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      const double q = limit(p, share), h = 1e-3;
      const CylinderPosition at = cylinder.at(q);
      EXPECT_NEAR(at.length, length(p, q), 1e-14);
      const auto difference = [&](double step) { return length(p, q + step) - length(p, q - step); };
      const double slope = (45.0 * difference(h) - 9.0 * difference(2 * h) + difference(3 * h)) / (60.0 * h);
      EXPECT_NEAR(at.arm, slope, 1e-11);
      EXPECT_NEAR(at.arm_rate, (cylinder.at(q + 1e-5).arm - cylinder.at(q - 1e-5).arm) / 2e-5, 1e-8);
      EXPECT_FALSE(at.zero_moment_arm) << p.name << " at " << q;
      EXPECT_GE(at.length, p.closed_length);
      EXPECT_LE(at.length, p.closed_length + p.stroke);
    }
  }
}

TEST_F(Cylinders, ForceDoesTheOppositeWorkOfTheLoad) {
  for (const CylinderParameters& p : parameters_.cylinders) {
    const Cylinder cylinder = make(p);
    for (double torque : {-7e3, 12e3}) {
      const CylinderPosition at = cylinder.at(limit(p, 0.4));
      const CylinderForce load = cylinder.load(at, torque);
      EXPECT_NEAR(load.force * at.arm, -torque, 1e-9);
      const double area = load.force > 0.0 ? cylinder.boreArea() : cylinder.rodArea();
      EXPECT_NEAR(load.pressure * area, std::abs(load.force), 1e-9);
      EXPECT_FALSE(load.zero_moment_arm);
    }
  }
}

TEST_F(Cylinders, StiffnessIsThatOfTheTrappedOil) {
  const CylinderParameters& p = parameters_.cylinders[0];
  const Cylinder cylinder = make(p);
  // A small move dL changes the pressures by dp = B A dL/V on each side. Both give the force.
  const double length = p.closed_length + 0.3 * p.stroke, dL = 1e-6, pi = 3.14159265358979323846;
  const double bore_area = pi / 4.0 * p.bore * p.bore;
  const double rod_area = bore_area - pi / 4.0 * p.rod_diameter * p.rod_diameter;
  const double bore_volume = p.bore_hose_volume + bore_area * 0.3 * p.stroke;
  const double rod_volume = p.rod_hose_volume + rod_area * 0.7 * p.stroke;
  const double force =
      kBulkModulus * bore_area * dL / bore_volume * bore_area + kBulkModulus * rod_area * dL / rod_volume * rod_area;
  EXPECT_NEAR(cylinder.stiffness(length) * dL, force, 1e-12 * force);
  const CylinderPosition at = cylinder.at(-0.35);
  EXPECT_DOUBLE_EQ(cylinder.jointStiffness(at), cylinder.stiffness(at.length) * at.arm * at.arm);
  // Beyond the stroke the stiffness is that at its end, finite and positive.
  EXPECT_EQ(cylinder.stiffness(0.0), cylinder.stiffness(p.closed_length));
  EXPECT_NEAR(cylinder.stiffness(9.0) / cylinder.stiffness(p.closed_length + p.stroke), 1.0, 1e-12);
}

TEST_F(Cylinders, DeadCentreIsReportedNotDividedBy) {
  CylinderParameters p = parameters_.cylinders[0];
  p.base_x = 0.25 - 1.0, p.base_z = 0.40, p.rod_x = 1.0, p.rod_z = 0.0;  // in line with the pivot at zero
  p.closed_length = 1.5, p.stroke = 0.6;
  const Cylinder cylinder = make(p);
  const CylinderPosition at = cylinder.at(0.0);
  EXPECT_TRUE(at.zero_moment_arm);
  EXPECT_NEAR(cylinder.jointStiffness(at), 0.0, 1e-9);
  const CylinderForce load = cylinder.load(at, 1e4);
  EXPECT_TRUE(load.zero_moment_arm);
  EXPECT_TRUE(std::isnan(load.force));
  EXPECT_TRUE(std::isnan(load.pressure));
  // Near the zero moment arm the force is finite and bounded by kZeroMomentArmRatio.
  for (double q = -0.5; q < 0.5; q += 1e-3) {
    const CylinderForce near = cylinder.load(cylinder.at(q), 1e4);
    if (near.zero_moment_arm) continue;
    EXPECT_LE(std::abs(near.force), 1e4 / (Cylinder::kZeroMomentArmRatio * 1.0) * (1.0 + 1e-12));
  }
}

TEST_F(Cylinders, ReportsEachFault) {
  const CylinderParameters good = parameters_.cylinders[0];
  const auto problem = [&](auto change) {
    CylinderParameters p = good;
    change(p);
    const Checked<Cylinder> made = Cylinder::make(p, kBulkModulus, chain_);
    EXPECT_FALSE(made.value);
    EXPECT_EQ(made.problems.size(), 1U);
    return made.problems.empty() ? "" : made.problems.front();
  };
  EXPECT_TRUE(Cylinder::make(good, kBulkModulus, chain_).value);
  EXPECT_EQ(problem([](auto& p) { p.bore = -0.1; }), "boom_cylinder_bore_m: -0.1 m, must be from 1e-06 to 1000 m");
  EXPECT_EQ(problem([](auto& p) { p.rod_diameter = 0.2; }),
            "boom_cylinder_rod_diameter_m: 0.2 m, must be < boom_cylinder_bore_m = 0.11 m");
  EXPECT_EQ(problem([](auto& p) { p.closed_length = 0.6; }),
            "boom_cylinder_closed_length_m: 0.6 m, must be > boom_cylinder_stroke_m = 0.65 m");
  EXPECT_EQ(problem([](auto& p) { p.base_x = std::nan(""); }),
            "boom_cylinder_base_x_m: nan m, must be from -1000 to 1000 m");
  EXPECT_EQ(problem([](auto& p) { p.bore_hose_volume = 0.0; }),
            "boom_cylinder_bore_hose_volume_m3: 0 m3, must be from 1e-12 to 1e+06 m3");
  EXPECT_EQ(problem([](auto& p) { p.joint = "knee_joint"; }),
            "boom_cylinder_joint: knee_joint, must be a revolute joint of the chain");
  EXPECT_EQ(problem([](auto& p) { p.rod_x = p.rod_z = 0.0; }),
            "boom_cylinder_joint: boom_joint, an anchor lies on its axis, must be beside it");
  CylinderParameters far = good;
  far.rod_x = 2.4;
  EXPECT_EQ(
      problem([](auto& p) { p.rod_x = 2.4; }),
      format("boom_cylinder_closed_length_m: 0.79 m, cannot close the triangle: at boom_joint = -0.95 rad its length "
             "must be %.6g m, from closed to open are 0.79 to 1.44 m",
             length(far, -0.95)));
}

TEST_F(Cylinders, GiveOneForceForBothSignsOfTheJointAxis) {
  // Reversal of the joint's axis reverses its angle and torque. The cylinder's force remains.
  std::string urdf = test::shippedUrdf();
  const std::size_t joint = urdf.find("name=\"boom_joint\"");
  const std::size_t axis = urdf.find("0 1 0", joint), limit = urdf.find("lower=\"-0.95\" upper=\"0.60\"", joint);
  urdf.replace(limit, 26, "lower=\"-0.60\" upper=\"0.95\"");
  urdf.replace(axis, 5, "0 -1 0");
  const Checked<Chain> chain = Chain::make(urdf, {});
  ASSERT_TRUE(chain.value) << chain.problems.front();
  const CylinderParameters& p = parameters_.cylinders[0];
  const Cylinder there = make(p), back = *Cylinder::make(p, kBulkModulus, *chain.value).value;
  EXPECT_NEAR(there.at(-0.3).length, back.at(0.3).length, 1e-15);
  EXPECT_NEAR(there.at(-0.3).arm, -back.at(0.3).arm, 1e-15);
  EXPECT_NEAR(there.load(there.at(-0.3), 5e3).force, back.load(back.at(0.3), -5e3).force, 1e-9);
}

}  // namespace
}  // namespace hammer_loads
