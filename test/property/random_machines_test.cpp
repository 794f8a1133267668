// Laws of mechanics that every machine must keep, on a hundred thousand random ones.
#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <complex>
#include <limits>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/linkage/pin_forces.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using Complex = std::complex<double>;

constexpr int kMachines = 100000;
constexpr int kQuadratureMachines = 2000;
constexpr Complex kI{0.0, 1.0};

Complex complex(Planar a) { return {a.re, a.im}; }

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  std::size_t index(std::size_t size) { return std::uniform_int_distribution<std::size_t>(0, size - 1)(random_); }
  /// Its rod misses the change-point condition by as much as is allowed.
  HammerParameters parameters() {
    HammerParameters p = test::randomParameters(random_);
    p.lengths.rod += 0.999e-3 * between(-1.0, 1.0) * p.lengths.crank;
    return p;
  }
  CrankAngle angle() { return CrankAngle::fromOffset(between(-kPi, kPi)); }
  CrankMotion crank() { return {angle(), between(-60.0, 60.0), between(-2000.0, 2000.0)}; }
  Gravity gravity() {
    const double pitch = between(-kPi, kPi);
    return {9.81 * std::sin(pitch), -9.81 * std::cos(pitch)};
  }

 private:
  std::mt19937 random_;
};

/// Worst of many errors and where it was.
struct Worst {
  double error{};
  int machine{-1};
  void take(double candidate, int i) {
    if (candidate <= error) return;  // a NaN is taken
    error = candidate;
    machine = i;
  }
};

TEST(RandomMachines, LoopStaysClosedAndLinksKeepTheirLengths) {
  Draw draw(1);
  Worst loop, rod, rate, unit;
  for (int i = 0; i < kMachines; ++i) {
    const Mechanism mechanism = test::mechanismOf(draw.parameters());
    const LinkLengths& l = mechanism.linkage().lengths();
    const LinkMotion m = linkMotion(mechanism.linkage(), draw.angle());
    const Complex b = l.crank * complex(m.phi), c = l.pivot_distance + l.rocker * complex(m.psi);
    const double size = l.pivot_distance + l.rocker;
    loop.take(std::abs(b + l.rod * complex(m.beta) - c) / size, i);
    rod.take(std::abs(std::abs(c - b) - l.rod) / size, i);
    for (Planar direction : {m.phi, m.beta, m.psi}) unit.take(std::abs(std::abs(complex(direction)) - 1.0), i);
    // The loop's rate per crank angle: i l1 e^(i phi) + i l2 v e^(i beta) = i l3 u e^(i psi).
    const Complex closing = b + m.v * l.rod * complex(m.beta) - m.rocker.u * l.rocker * complex(m.psi);
    rate.take(std::abs(closing) / (l.crank + l.rod * std::abs(m.v) + l.rocker * std::abs(m.rocker.u)), i);
  }
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();  // some twenty operations
  EXPECT_LE(loop.error, kRounding) << loop.machine;
  EXPECT_LE(rod.error, kRounding) << rod.machine;
  EXPECT_LE(unit.error, kRounding) << unit.machine;
  EXPECT_LE(rate.error, kRounding) << rate.machine;
}

/// Momentum, energy and weight power from each link's own mass and motion.
struct Links {
  Complex momentum;       ///< mechanism frame [N s]
  double kinetic_energy;  ///< [J]
};

Links linksOf(const Mechanism& mechanism, CrankAngle angle, double speed) {
  const HammerParameters& p = mechanism.parameters();
  const LinkMotion m = linkMotion(mechanism.linkage(), angle);
  const Complex crank{p.crank_com_along, p.crank_com_across}, rod{p.rod_com_along, p.rod_com_across};
  const Complex rocker = std::polar(p.rocker_com_distance, p.rocker_com_angle);
  const Complex crank_rate = speed * kI * complex(m.phi), rod_rate = m.v * speed * kI * complex(m.beta),
                rocker_rate = m.rocker.u * speed * kI * complex(m.psi);
  const Complex v1 = crank * crank_rate, v2 = p.lengths.crank * crank_rate + rod * rod_rate, v3 = rocker * rocker_rate;
  Links links;
  links.momentum = p.crank_mass * v1 + p.rod_mass * v2 + p.rocker_mass * v3;
  const double rocker_about_com =
      p.rocker_inertia_about_pivot - p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance;
  links.kinetic_energy =
      0.5 * (p.crank_mass * std::norm(v1) + p.rod_mass * std::norm(v2) + p.rocker_mass * std::norm(v3) +
             p.crank_inertia_about_com * std::norm(crank_rate) + p.rod_inertia_about_com * std::norm(rod_rate) +
             rocker_about_com * std::norm(rocker_rate));
  return links;
}

/// Power of the weight of moving links with a momentum in the mechanism frame (model.md 1: a mirror) [W].
double weightPower(const Mechanism& mechanism, Complex momentum, Gravity gravity) {
  const double c = mechanism.cosComAngle(), s = mechanism.sinComAngle();
  return -(c * momentum.real() + s * momentum.imag()) * gravity.x +
         (c * momentum.imag() - s * momentum.real()) * gravity.z;
}

TEST(RandomMachines, DrivePowerIsTheRateOfEnergyLessThePowerOfWeight) {
  Draw draw(2);
  Worst from_pins, from_shaft;
  for (int i = 0; i < kMachines; ++i) {
    const Mechanism mechanism = test::mechanismOf(draw.parameters());
    CrankMotion crank = draw.crank();
    crank.speed += std::copysign(1.0, crank.speed);
    const Gravity gravity = draw.gravity();
    const double h = 2e-4 / std::max(std::abs(crank.speed), std::sqrt(std::abs(crank.acceleration)));  // [s]
    crank.angle.offset *= 0.999;  // the stencil stays within half a turn
    const auto energy = [&](double t) {
      CrankAngle angle = crank.angle;
      angle.offset += t * (crank.speed + 0.5 * t * crank.acceleration);
      return linksOf(mechanism, angle, crank.speed + t * crank.acceleration).kinetic_energy;
    };
    const double rate = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
    const Links links = linksOf(mechanism, crank.angle, crank.speed);
    const double weight = weightPower(mechanism, links.momentum, gravity);
    const double expected = rate - weight;
    const double size = std::abs(rate) + std::abs(weight) + std::abs(crank.speed) * links.kinetic_energy;
    const double pins =
        pinForces(mechanism, Level::kLinkage, crank, gravity, NearBlow(0.01)).drive_torque * crank.speed;
    const double shaft = crank.speed * test::driveTorque(shaftLoad(mechanism, Level::kLinkage, crank.angle, gravity),
                                                   crank.speed, crank.acceleration);
    // Next to the blow the pin forces lose digits with the sine of half the crank angle.
    const double sine = std::abs(std::sin(0.5 * crank.angle.offset));
    from_pins.take(std::abs(pins - expected) / size * std::min(1.0, 100.0 * sine), i);
    from_shaft.take(std::abs(shaft - expected) / size, i);
  }
  // Steps of at most 2e-4 rad: rounding of the difference some 1e-12, truncation (2e-4/0.1)^4 times a derivative.
  EXPECT_LE(from_pins.error, 2e-10) << from_pins.machine;
  EXPECT_LE(from_shaft.error, 2e-10) << from_shaft.machine;
}

TEST(RandomMachines, ImpulseIsMinusTheChangeOfMomentum) {
  Draw draw(3);
  std::array<Worst, 2> force, moment;
  using Quadrature = boost::math::quadrature::gauss<double, 20>;
  for (int i = 0; i < kQuadratureMachines; ++i) {
    const Mechanism mechanism = test::mechanismOf(draw.parameters());
    for (const Level level : {Level::kRocker, Level::kLinkage}) {
      // 0.25 rad on one side of the blow, at a varying speed.
      const double speed = draw.between(5.0, 60.0), acceleration = draw.between(-500.0, 500.0);
      const double start = draw.index(2) == 0 ? draw.between(0.0, 2.6) : draw.between(-3.1, -0.5);
      const double duration = 0.25 / speed;
      const auto crankAt = [&](double t) {
        const Side side = start < 0.0 ? Side::kBeforeBlow : Side::kAfterBlow;
        return CrankMotion{
            {start + t * (speed + 0.5 * t * acceleration), side}, speed + t * acceleration, acceleration};
      };
      const auto impulse = [&](double HullWrench::*component) {
        double sum = 0.0;  // in pieces: the sharpest machine changes within some 0.1 rad
        constexpr int kPieces = 4;
        for (int k = 0; k < kPieces; ++k) {
          sum +=
              Quadrature::integrate([&](double t) { return hullWrench(mechanism, level, crankAt(t), {}).*component; },
                                    duration * k / kPieces, duration * (k + 1) / kPieces);
        }
        return sum;
      };
      const CrankMotion from = crankAt(0.0), to = crankAt(duration);
      const LinkMomentum before = linkMomentum(mechanism, level, from.angle, from.speed);
      const LinkMomentum after = linkMomentum(mechanism, level, to.angle, to.speed);
      const double size = std::hypot(before.x, before.z) + std::hypot(after.x, after.z);
      const double moment_size =
          std::abs(before.about_d) + std::abs(after.about_d) + size * mechanism.linkage().lengths().rocker;
      const auto at = static_cast<std::size_t>(level == Level::kLinkage);
      force[at].take(std::hypot(impulse(&HullWrench::force_x) + after.x - before.x,
                                impulse(&HullWrench::force_z) + after.z - before.z) /
                         size,
                     i);
      moment[at].take(std::abs(impulse(&HullWrench::torque_y) + after.about_d - before.about_d) / moment_size, i);
    }
  }
  for (std::size_t level : {0U, 1U}) {
    EXPECT_LE(force[level].error, 1e-11) << level << ' ' << force[level].machine;
    EXPECT_LE(moment[level].error, 1e-11) << level << ' ' << moment[level].machine;
  }
}

TEST(RandomMachines, MasslessCrankAndRodLeaveLevelRocker) {
  Draw draw(4);
  Worst wrench, momentum, pins, shaft;
  for (int i = 0; i < kMachines; ++i) {
    HammerParameters p = draw.parameters();
    p.crank_mass = p.rod_mass = p.crank_inertia_about_com = p.rod_inertia_about_com = 0.0;
    const Mechanism mechanism = test::mechanismOf(p);
    const CrankMotion crank = draw.crank();
    const Gravity gravity = draw.gravity();
    const HullWrench a = hullWrench(mechanism, Level::kRocker, crank, gravity);
    const HullWrench b = hullWrench(mechanism, Level::kLinkage, crank, gravity);
    const Motion m = motion(mechanism.linkage(), crank.angle);
    const double psi_accel = m.du * crank.speed * crank.speed + m.u * crank.acceleration;
    const double force = mechanism.rockerFirstMoment() *
                             (m.u * m.u * crank.speed * crank.speed + std::abs(m.du * crank.speed * crank.speed) +
                              std::abs(m.u * crank.acceleration)) +
                         p.rocker_mass * 9.81;
    const double torque = p.rocker_inertia_about_pivot * std::abs(psi_accel) + force * p.rocker_com_distance;
    wrench.take(std::hypot(a.force_x - b.force_x, a.force_z - b.force_z) / force, i);
    wrench.take(std::abs(a.torque_y - b.torque_y) / torque, i);
    const LinkMomentum c = linkMomentum(mechanism, Level::kRocker, crank.angle, crank.speed);
    const LinkMomentum d = linkMomentum(mechanism, Level::kLinkage, crank.angle, crank.speed);
    momentum.take(std::hypot(c.x - d.x, c.z - d.z) / (std::hypot(c.x, c.z) + 1e-300), i);
    const PinReactions poor = pinForces(mechanism, Level::kRocker, crank, gravity, NearBlow(0.01));
    const PinReactions rich = pinForces(mechanism, Level::kLinkage, crank, gravity, NearBlow(0.01));
    const double size = force + std::hypot(poor.rod_on_rocker.x, poor.rod_on_rocker.z);
    pins.take(
        std::hypot(poor.rod_on_rocker.x - rich.rod_on_rocker.x, poor.rod_on_rocker.z - rich.rod_on_rocker.z) / size, i);
    const ShaftLoad e = shaftLoad(mechanism, Level::kRocker, crank.angle, gravity);
    const ShaftLoad f = shaftLoad(mechanism, Level::kLinkage, crank.angle, gravity);
    shaft.take(std::abs(e.inertia - f.inertia) / e.inertia, i);
  }
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
  EXPECT_LE(wrench.error, kRounding) << wrench.machine;
  EXPECT_LE(momentum.error, kRounding) << momentum.machine;
  EXPECT_LE(pins.error, kRounding) << pins.machine;
  EXPECT_LE(shaft.error, kRounding) << shaft.machine;
}

/// Every number that a mechanism gives at a state of the crank.
std::vector<double> everything(const Mechanism& mechanism, Level level, const CrankMotion& crank, Gravity gravity) {
  const HullWrench w = hullWrench(mechanism, level, crank, gravity);
  const LinkMomentum m = linkMomentum(mechanism, level, crank.angle, crank.speed);
  const ShaftLoad s = shaftLoad(mechanism, level, crank.angle, gravity);
  const PinReactions p = pinForces(mechanism, level, crank, gravity, NearBlow(0.01));
  const RockerBlow b = blowAtCrankSpeed(mechanism, level, std::abs(crank.speed) + 1.0);
  return {w.force_x,
          w.force_z,
          w.torque_y,
          m.x,
          m.z,
          m.about_d,
          s.inertia,
          s.half_inertia_slope,
          s.weight_torque,
          s.weight_torque_slope,
          p.hull_on_crank.x,
          p.hull_on_crank.z,
          p.crank_on_rod.x,
          p.crank_on_rod.z,
          p.rod_on_rocker.x,
          p.rod_on_rocker.z,
          p.hull_on_rocker.x,
          p.hull_on_rocker.z,
          p.drive_torque,
          b.rocker_speed_before,
          b.rocker_speed_after,
          b.restitution,
          b.energy,
          b.friction_work,
          b.tool_impulse_x,
          b.tool_impulse_z,
          b.support_impulse_x,
          b.support_impulse_z};
}

using Field = double& (*)(HammerParameters&);
constexpr Field kFields[] = {
    [](HammerParameters& p) -> double& { return p.lengths.crank; },
    [](HammerParameters& p) -> double& { return p.lengths.rod; },
    [](HammerParameters& p) -> double& { return p.lengths.rocker; },
    [](HammerParameters& p) -> double& { return p.lengths.pivot_distance; },
    [](HammerParameters& p) -> double& { return p.rocker_com_distance; },
    [](HammerParameters& p) -> double& { return p.rocker_com_angle; },
    [](HammerParameters& p) -> double& { return p.rocker_mass; },
    [](HammerParameters& p) -> double& { return p.rocker_inertia_about_pivot; },
    [](HammerParameters& p) -> double& { return p.striking_distance; },
    [](HammerParameters& p) -> double& { return p.striking_friction; },
    [](HammerParameters& p) -> double& { return p.crank_mass; },
    [](HammerParameters& p) -> double& { return p.crank_com_along; },
    [](HammerParameters& p) -> double& { return p.crank_com_across; },
    [](HammerParameters& p) -> double& { return p.crank_inertia_about_com; },
    [](HammerParameters& p) -> double& { return p.rod_mass; },
    [](HammerParameters& p) -> double& { return p.rod_com_along; },
    [](HammerParameters& p) -> double& { return p.rod_com_across; },
    [](HammerParameters& p) -> double& { return p.rod_inertia_about_com; },
    [](HammerParameters& p) -> double& { return p.drive_inertia; },
};

/// One to three fields of a good machine become garbage; lengths at times keep the change-point condition.
HammerParameters garbage(Draw& draw) {
  using Limits = std::numeric_limits<double>;
  const double kValues[] = {Limits::quiet_NaN(),
                            Limits::infinity(),
                            -Limits::infinity(),
                            1e308,
                            -1e308,
                            1e300,
                            1e200,
                            1e155,
                            1e100,
                            1e30,
                            1e12,
                            1e-12,
                            1e-30,
                            1e-100,
                            1e-160,
                            1e-200,
                            1e-300,
                            5e-324,
                            -5e-324,
                            0.0,
                            -0.0,
                            1.0,
                            -1.0,
                            57.3};
  HammerParameters p = draw.parameters();
  const std::size_t changes = 1 + draw.index(3);
  for (std::size_t k = 0; k < changes; ++k)
    kFields[draw.index(std::size(kFields))](p) = kValues[draw.index(std::size(kValues))];
  if (draw.index(2) == 0) p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  if (draw.index(4) == 0)
    p.rocker_inertia_about_pivot = 2.0 * p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance;
  if (draw.index(8) == 0) {
    const double scale = std::pow(10.0, draw.between(-320.0, 308.0));
    p.lengths = {p.lengths.crank * scale, p.lengths.rod * scale, p.lengths.rocker * scale,
                 p.lengths.pivot_distance * scale};
  }
  return p;
}

TEST(RandomMachines, GarbageIsRefusedWithReasonsOrGivesFiniteLoads) {
  Draw draw(5);
  int refused = 0, accepted = 0;
  for (int i = 0; i < kMachines; ++i) {
    const Checked<Mechanism> made = Mechanism::make(garbage(draw));
    if (!made.value) {
      ++refused;
      ASSERT_FALSE(made.problems.empty()) << i;
      for (const std::string& problem : made.problems) {
        ASSERT_NE(problem.find(": "), std::string::npos) << problem;
        ASSERT_NE(problem.find("must be"), std::string::npos) << problem;
        ASSERT_EQ(problem.find('\n'), std::string::npos) << problem;
      }
      continue;
    }
    ++accepted;
    CrankMotion crank = draw.crank();
    crank.angle.offset = std::copysign(std::max(1e-6, std::abs(crank.angle.offset)), crank.angle.offset);
    for (const Level level : {Level::kRocker, Level::kLinkage}) {
      for (const double value : everything(*made.value, level, crank, draw.gravity()))
        ASSERT_TRUE(std::isfinite(value)) << i;
    }
  }
  EXPECT_GT(refused, kMachines / 4);
  EXPECT_GT(accepted, kMachines / 10);
}

}  // namespace
}  // namespace hammer_loads
