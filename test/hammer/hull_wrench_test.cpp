#include "hammer_loads/hammer/hull_wrench.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "hammer_loads/linkage/pin_forces.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "support/csv.h"
#include "support/mo100.h"
#include "support/newton_euler.h"

namespace hammer_loads {
namespace {

using test::Real;
constexpr Gravity kGravity{3.1, -9.3};

TEST(HullWrench, EqualsTheReferenceTables) {
  for (const auto& [name, level, tolerance] : {std::tuple{"mo100_constant_speed.csv", Level::kRocker, 1e-13},
                                               std::tuple{"mo100_linkage.csv", Level::kLinkage, 1e-12}}) {
    const test::Csv csv = test::dataCsv(name);
    const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
    const double peak_x = csv.peak("hull_force_x_N"), peak_z = csv.peak("hull_force_z_N");
    const double peak_torque = csv.peak("hull_torque_y_Nm");
    for (std::size_t i = 0; i < csv.size(); ++i) {
      const double g = csv.number(i, "gravity_m_s2"), pitch = csv.number(i, "hull_pitch_rad");
      const CrankMotion crank{CrankAngle::fromAngle(csv.number(i, "crank_angle_rad")),
                              csv.number(i, "crank_speed_rad_s"), csv.number(i, "crank_accel_rad_s2")};
      const HullWrench wrench = hullWrench(mechanism, level, crank, {g * std::sin(pitch), -g * std::cos(pitch)});
      EXPECT_NEAR(wrench.force_x, csv.number(i, "hull_force_x_N"), tolerance * peak_x) << name << ' ' << i;
      EXPECT_NEAR(wrench.force_z, csv.number(i, "hull_force_z_N"), tolerance * peak_z) << name << ' ' << i;
      EXPECT_NEAR(wrench.torque_y, csv.number(i, "hull_torque_y_Nm"), tolerance * peak_torque) << name << ' ' << i;
    }
  }
}

TEST(HullWrench, KeepsAllDigitsNearTheBlowForAnyMachine) {
  std::mt19937 random(41);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    double worst = 0.0, worst_torque = 0.0;
    for (int i = 0; i < 8; ++i) {
      const HammerParameters p = i == 0 ? test::mo100LinkageParameters() : test::randomParameters(random);
      const Mechanism mechanism = test::mechanismOf(p);
      const test::NewtonEuler exact(p, level);
      for (double e : {0.0, -1500.0}) {
        double torque_peak = 0.0, torque_error = 0.0;
        for (int decade = 1; decade <= 12; ++decade) {
          for (double sign : {-1.0, 1.0}) {
            const CrankMotion crank{CrankAngle::fromOffset(sign * 1.3 * std::pow(10.0, -decade)), 30.0, e};
            const HullWrench wrench = hullWrench(mechanism, level, crank, {});
            const test::Reference reference = exact.at(crank.angle, crank.speed, e, {});
            const auto relative = [](double value, const Real& right) {
              return static_cast<double>(abs(Real(value) - right) / abs(right));
            };
            worst = std::max({worst, relative(wrench.force_x, reference.hull_force.x),
                              relative(wrench.force_z, reference.hull_force.y)});
            torque_peak = std::max(torque_peak, std::abs(wrench.torque_y));
            torque_error =
                std::max(torque_error, std::abs(static_cast<double>(Real(wrench.torque_y) - reference.hull_torque)));
          }
        }
        worst_torque = std::max(worst_torque, torque_error / torque_peak);
      }
    }
    EXPECT_LE(worst, 1e-13) << static_cast<int>(level);
    EXPECT_LE(worst_torque, 1e-13) << static_cast<int>(level);
    std::printf("level %d near the blow: force %.2e relative, torque %.2e of the peak\n", static_cast<int>(level),
                worst, worst_torque);
  }
}

TEST(HullWrench, EqualsKinetostaticsOverTheTurn) {
  // The forces of all pins on the hull, from Newton and Euler for each link in 100 digits.
  std::mt19937 random(42);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (int i = 0; i < 5; ++i) {
      const HammerParameters p = test::randomParameters(random);
      const Mechanism mechanism = test::mechanismOf(p);
      const test::NewtonEuler exact(p, level);
      double peak = 0.0, error = 0.0, torque_peak = 0.0, torque_error = 0.0;
      for (double offset = -3.1; offset < 3.1; offset += 0.143) {
        const CrankMotion crank{CrankAngle::fromOffset(offset), -20.0, 300.0};
        const HullWrench wrench = hullWrench(mechanism, level, crank, kGravity);
        const test::Reference reference = exact.at(crank.angle, -20.0, 300.0, kGravity);
        const double miss_x = static_cast<double>(Real(wrench.force_x) - reference.hull_force.x);
        const double miss_z = static_cast<double>(Real(wrench.force_z) - reference.hull_force.y);
        peak = std::max(peak, std::hypot(wrench.force_x, wrench.force_z));
        error = std::max(error, std::hypot(miss_x, miss_z));
        torque_peak = std::max(torque_peak, std::abs(wrench.torque_y));
        torque_error =
            std::max(torque_error, std::abs(static_cast<double>(Real(wrench.torque_y) - reference.hull_torque)));
      }
      EXPECT_LE(error, 1e-13 * peak);
      EXPECT_LE(torque_error, 1e-13 * torque_peak);
    }
  }
}

TEST(HullWrench, EqualsThePinForcesOnTheHull) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const double c = mechanism.cosComAngle(), s = mechanism.sinComAngle(), l0 = 0.078;
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (double phi = 0.2; phi < 6.2; phi += 0.11) {
      const CrankMotion crank{CrankAngle::fromAngle(phi), 31.0, -800.0};
      const HullWrench wrench = hullWrench(mechanism, level, crank, kGravity);
      const PinReactions pins = pinForces(mechanism, level, crank, kGravity, NearBlow(0.01));
      EXPECT_NEAR(wrench.force_x, -pins.hull_on_crank.x - pins.hull_on_rocker.x, 1e-12 * 60000.0);
      EXPECT_NEAR(wrench.force_z, -pins.hull_on_crank.z - pins.hull_on_rocker.z, 1e-12 * 60000.0);
      // A lies at -l0 along xi, in hull axes l0 (c, s); a moment about +y is z Fx - x Fz.
      const double moment = -(l0 * s * pins.hull_on_crank.x - l0 * c * pins.hull_on_crank.z) - pins.drive_torque;
      EXPECT_NEAR(wrench.torque_y, moment, 1e-12 * 10000.0);
    }
  }
}

/// Crank at offset x0 + w0 t + e/2 t^2.
struct Path {
  double x0, w0, e;
  CrankMotion at(double t) const { return {CrankAngle::fromOffset(x0 + t * (w0 + 0.5 * e * t)), w0 + e * t, e}; }
};

TEST(HullWrench, ImpulseIsTheMomentumDifference) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  std::mt19937 random(43);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (int i = 0; i < 4; ++i) {
      const Mechanism mechanism =
          test::mechanismOf(i == 0 ? test::mo100LinkageParameters() : test::randomParameters(random));
      for (const Path& path : {Path{0.02, 25.0, 120.0}, Path{-3.0, 31.0, 0.0}, Path{-0.02, -25.0, 60.0}}) {
        const double duration = 0.07;
        const auto impulse = [&](double HullWrench::*member) {
          return Quadrature::integrate([&](double t) { return hullWrench(mechanism, level, path.at(t), {}).*member; },
                                       0.0, duration, 10, 1e-13);
        };
        const auto momentum = [&](double t) {
          const CrankMotion crank = path.at(t);
          return linkMomentum(mechanism, level, crank.angle, crank.speed);
        };
        const LinkMomentum begin = momentum(0.0), end = momentum(duration);
        const double scale = std::hypot(begin.x, begin.z) + std::hypot(end.x, end.z);
        EXPECT_NEAR(impulse(&HullWrench::force_x), begin.x - end.x, 1e-10 * scale);
        EXPECT_NEAR(impulse(&HullWrench::force_z), begin.z - end.z, 1e-10 * scale);
        EXPECT_NEAR(impulse(&HullWrench::torque_y), begin.about_d - end.about_d,
                    1e-10 * (std::abs(begin.about_d) + std::abs(end.about_d)));
      }
    }
  }
}

TEST(HullWrench, MomentumEqualsTheReference) {
  std::mt19937 random(44);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    const HammerParameters p = test::randomParameters(random);
    const Mechanism mechanism = test::mechanismOf(p);
    const test::NewtonEuler exact(p, level);
    for (double offset = -3.1; offset < 3.1; offset += 0.4) {
      const CrankAngle angle = CrankAngle::fromOffset(offset);
      const LinkMomentum momentum = linkMomentum(mechanism, level, angle, 7.0);
      const test::Reference reference = exact.at(angle, 7.0, 0.0, {});
      const double scale = p.rocker_mass * 7.0 * (p.lengths.rod + p.rocker_com_distance) * 4.0;
      EXPECT_NEAR(momentum.x, static_cast<double>(reference.momentum.x), 1e-14 * scale);
      EXPECT_NEAR(momentum.z, static_cast<double>(reference.momentum.y), 1e-14 * scale);
      EXPECT_NEAR(momentum.about_d, static_cast<double>(reference.momentum_about_d),
                  1e-14 * scale * p.lengths.rod * 4.0);
    }
  }
}

TEST(HullWrench, DriveFeedsTheChangeOfEnergy) {
  // Power balance along a path: work of drive and weight = change of kinetic energy.
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const Path path{0.05, 28.0, -90.0};
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    const auto power = [&](double t) {
      const CrankMotion crank = path.at(t);
      const ShaftLoad load = shaftLoad(mechanism, level, crank.angle, kGravity);
      const PinReactions pins = pinForces(mechanism, level, crank, kGravity, NearBlow(0.01));
      return (pins.drive_torque + load.weight_torque) * crank.speed;
    };
    const auto energy = [&](double t) {
      const CrankMotion crank = path.at(t);
      return 0.5 * shaftLoad(mechanism, level, crank.angle, kGravity).inertia * crank.speed * crank.speed;
    };
    const double duration = 0.09;
    EXPECT_NEAR(Quadrature::integrate(power, 0.0, duration, 10, 1e-12), energy(duration) - energy(0.0), 1e-9 * 1000.0);
  }
}

TEST(HullWrench, MasslessCrankAndRodLeaveTheRocker) {
  HammerParameters p = test::mo100LinkageParameters();
  p.crank_mass = p.rod_mass = p.crank_inertia_about_com = p.rod_inertia_about_com = 0.0;
  const Mechanism mechanism = test::mechanismOf(p);
  for (double offset = -3.1; offset < 3.1; offset += 0.1) {
    const CrankMotion crank{CrankAngle::fromOffset(offset), 31.0, 1200.0};
    const HullWrench poor = hullWrench(mechanism, Level::kRocker, crank, kGravity);
    const HullWrench rich = hullWrench(mechanism, Level::kLinkage, crank, kGravity);
    EXPECT_NEAR(rich.force_x, poor.force_x, 1e-15 * 60000.0 * 4.0);
    EXPECT_NEAR(rich.force_z, poor.force_z, 1e-15 * 60000.0 * 4.0);
    EXPECT_NEAR(rich.torque_y, poor.torque_y, 1e-15 * 10000.0 * 4.0);
  }
}

TEST(HullWrench, LightCrankAndRodApproachTheRockerInProportion) {
  const CrankMotion crank{CrankAngle::fromAngle(5.5), 31.0, 100.0};
  const auto miss = [&](double scale) {
    HammerParameters p = test::mo100LinkageParameters();
    for (double* value : {&p.crank_mass, &p.rod_mass, &p.crank_inertia_about_com, &p.rod_inertia_about_com})
      *value *= scale;
    const Mechanism mechanism = test::mechanismOf(p);
    return hullWrench(mechanism, Level::kLinkage, crank, kGravity).force_z -
           hullWrench(mechanism, Level::kRocker, crank, kGravity).force_z;
  };
  EXPECT_GT(std::abs(miss(1.0)), 10.0);
  EXPECT_NEAR(miss(1e-3) / miss(1.0), 1e-3, 1e-9);
}

TEST(HullWrench, IsTheWeightAtRest) {
  const HammerParameters p = test::mo100LinkageParameters();
  const Mechanism mechanism = test::mechanismOf(p);
  const CrankMotion still{CrankAngle::fromAngle(1.0), 0.0, 0.0};
  EXPECT_DOUBLE_EQ(hullWrench(mechanism, Level::kRocker, still, kGravity).force_z, 35.2 * kGravity.z);
  EXPECT_DOUBLE_EQ(hullWrench(mechanism, Level::kLinkage, still, kGravity).force_x, 45.7 * kGravity.x);
  EXPECT_DOUBLE_EQ(movingMass(mechanism, Level::kRocker), 35.2);
  EXPECT_DOUBLE_EQ(movingMass(mechanism, Level::kLinkage), 45.7);
}

TEST(HullWrench, TracksThePapersFigureAtThreeHundredAndFiftyDegrees) {
  // P0 gives H = 39 895 N, read at 350 deg.
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const CrankMotion crank{CrankAngle::fromAngle(350.0 * kPi / 180.0), test::kPaperSpeed, 0.0};
  EXPECT_NEAR(hullWrench(mechanism, Level::kRocker, crank, {}).force_z, 39899.7, 0.05);
}

/// P0 (1)-(5), (13), (14) as printed: inverse trigonometry, and P_tau with the sign of the acceleration.
struct Printed {
  double force_x{}, force_z{};
};

Printed asPrinted(const HammerParameters& p, double phi, double w, double sign_of_tangential) {
  const double l0 = p.lengths.pivot_distance / p.lengths.crank, l2 = p.lengths.rod / p.lengths.crank;
  const double l3 = p.lengths.rocker / p.lengths.crank;
  const double d = 1 + l0 * l0 - 2 * l0 * std::cos(phi);
  const double psi = kPi - std::atan(std::sin(phi) / (l0 - std::cos(phi))) -
                     std::acos((l3 * l3 - l2 * l2 + l0 * l0 + 1 - 2 * l0 * std::cos(phi)) / (2 * l3 * std::sqrt(d)));
  const double s = std::sin(phi / 2), y = std::cos(phi / 2);
  const double u =
      (1 - l0 + 2 * l0 * s * s + (2 * l0 * s * s + l2 * (l0 - 1)) * y / std::sqrt(l2 * l3 / l0 - s * s)) / d;
  const double b = (1 - l0 * l0) / (2 * l0), g = l2 * l3 / l0 - 1, a = (l0 + 1) * (l0 + 1) / (4 * l0);
  const double c = l2 * (l0 - 1) / (2 * l0) + 1;
  const double y2 = y * y;
  const double du = -s / (4 * (a - y2) * (a - y2)) *
                    (b * y + ((g + 2 * (c - a)) * y2 * y2 + g * (c - 3 * a) * y2 + a * c * g) / std::pow(g + y2, 1.5));
  const double normal = p.rocker_mass * w * w * u * u * p.rocker_com_distance;
  const double tangential = sign_of_tangential * p.rocker_mass * w * w * du * p.rocker_com_distance;
  return {-normal * std::cos(psi) + tangential * std::sin(psi), normal * std::sin(psi) + tangential * std::cos(psi)};
}

TEST(PrintedFormulas, GiveEqualForcesWithTheSignMended) {
  const HammerParameters p = test::mo100Parameters();
  const Mechanism mechanism = test::mechanismOf(p);
  for (double phi = 0.05; phi < 6.25; phi += 0.05) {
    const Printed mended = asPrinted(p, phi, test::kPaperSpeed, -1.0);
    const HullWrench wrench =
        hullWrench(mechanism, Level::kRocker, {CrankAngle::fromAngle(phi), test::kPaperSpeed, 0.0}, {});
    EXPECT_NEAR(mended.force_x, wrench.force_x, 1e-10 * 55448.8);
    EXPECT_NEAR(mended.force_z, wrench.force_z, 1e-10 * 40558.0);
  }
}

TEST(PrintedFormulas, PeakAtAThirdAndPushOneWayOnlyAsPrinted) {
  const HammerParameters p = test::mo100Parameters();
  double highest_z = -1e9, highest_x = -1e9, lowest_x = 1e9, impulse_x = 0.0;
  constexpr int kSteps = 36000;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = 2.0 * kPi * (i + 0.5) / kSteps;
    const Printed printed = asPrinted(p, phi, test::kPaperSpeed, 1.0);
    highest_z = std::max(highest_z, printed.force_z);
    highest_x = std::max(highest_x, printed.force_x);
    lowest_x = std::min(lowest_x, printed.force_x);
    impulse_x += printed.force_x * 2.0 * kPi / kSteps / test::kPaperSpeed;
  }
  EXPECT_NEAR(highest_z, 13500.0, 50.0);
  EXPECT_LT(highest_x, 0.02 * -lowest_x) << "one sign, whereas the paper's figure 5 has both";
  EXPECT_LT(impulse_x, -400.0) << "whereas the paper finds no impulse along x";
}

}  // namespace
}  // namespace hammer_loads
