// Accuracy of each way to compute the loads, compared with the equations of Newton and Euler in 100 digits.
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "hammer/load_ways.h"

namespace hammer_loads::test {
namespace {

const HammerParameters kHammer = mo100LinkageParameters();

HardCase caseNamed(const std::string& name) {
  for (const HardCase& c : hardCases(kHammer)) {
    if (c.name == name) return c;
  }
  throw std::invalid_argument(name);
}

LoadWay wayNamed(const std::string& name) {
  for (const LoadWay& way : loadWays()) {
    if (way.name == name) return way;
  }
  throw std::invalid_argument(name);
}

void expectDigitsOf(const HardCase& hard_case, double relative, double of_peak) {
  for (const Level level : {Level::kRocker, Level::kLinkage}) {
    const ExactCase exact(hard_case, level);
    for (const LoadWay& way : loadWays()) {
      if (way.level != level || way.parts == Parts::kPrinted) continue;
      const Error error = errorOf(way.loads(hard_case), exact, way.parts);
      EXPECT_LE(error.relative, relative) << way.name << ", " << hard_case.name;
      EXPECT_LE(error.of_peak, of_peak) << way.name << ", " << hard_case.name;
    }
  }
}

TEST(LoadErrors, StayBelowTheBoundAtEveryLevelOnEveryHardCase) {
  for (const HardCase& hard_case : hardCases(kHammer)) expectDigitsOf(hard_case, 1e-13, 1e-14);
}

/// In mid-revolution a force of any machine may pass near zero. Its error is compared with the peak there.
TEST(LoadErrors, StayBelowTheBoundForAnyMachine) {
  std::mt19937 random(41);
  for (int i = 0; i < 3; ++i) {
    HardCase machine = caseNamed("after, to 1e-12 rad");
    machine.name = "machine " + std::to_string(i);
    machine.hammer = randomParameters(random);
    machine.speed = 30.0, machine.acceleration = i % 2 ? 300.0 : 0.0;
    for (const double side : {-1.0, 1.0}) {
      machine.angles = besideTheBlow(side, 1, 12, {2.7});
      expectDigitsOf(machine, 1e-13, 1e-13);
    }
    machine.angles = turnAngles(48);
    expectDigitsOf(machine, kNoNumber, 1e-13);
  }
}

HardCase atOffset(double offset) {
  HardCase one = caseNamed("regular turn");
  one.angles = {offset > 0.0 ? offset : kTwoPi + offset};
  return one;
}

TEST(PrintedFormulas, HoldInMidTurn) {
  HardCase middle = caseNamed("regular turn");
  middle.acceleration = -300.0;  // unlike P0 with acceleration and weight
  middle.angles.erase(std::remove_if(middle.angles.begin(), middle.angles.end(),
                                     [](double phi) { return phi < 0.5 || phi > kTwoPi - 0.5; }),
                      middle.angles.end());
  const ExactCase exact(middle, Level::kRocker);
  for (const char* name : {"P0 with inverse trigonometry", "P0 with sines and cosines"}) {
    const LoadWay way = wayNamed(name);
    EXPECT_LE(errorOf(way.loads(middle), exact, way.parts).relative, 1e-11) << name;
  }
}

TEST(PrintedFormulas, LoseTheirDigitsTowardsTheBlowWhereOursKeepThem) {
  for (const double side : {-1.0, 1.0}) {
    for (const auto& [offset, lost] : {std::pair{1e-3, 1e-11}, std::pair{1e-6, 1e-5}, std::pair{1e-9, 0.1}}) {
      const HardCase near_blow = atOffset(side * offset);
      const ExactCase exact(near_blow, Level::kRocker);
      for (const char* name : {"P0 with inverse trigonometry", "P0 with sines and cosines"}) {
        const LoadWay way = wayNamed(name);
        EXPECT_GE(errorOf(way.loads(near_blow), exact, way.parts).relative, lost) << name << ' ' << side * offset;
      }
      EXPECT_LE(errorOf(wayNamed("scalar pins").loads(near_blow), exact, Parts::kPins).relative, 1e-14);
    }
  }
}

/// P0 (1), (13) and (14) with the sign of the acceleration as printed.
TEST(PrintedFormulas, PeakAtAThirdAndPushOneWayOnlyAsPrinted) {
  const HammerParameters p = mo100Parameters();
  const Mechanism mechanism = mechanismOf(p);
  const PrintedFormulas printed(p, Positions::kTrigonometry);
  double highest_z = -1e9, highest_x = -1e9, lowest_x = 1e9, mean_x = 0.0;
  const std::vector<double> angles = turnAngles(36000);
  for (const double phi : angles) {
    const auto [u, du] = printed.transfer(phi);
    const double psi = rockerAngle(linkMotion(mechanism.linkage(), CrankAngle::fromAngle(phi)).rocker);
    const double size = p.rocker_mass * p.rocker_com_distance * kPaperSpeed * kPaperSpeed;
    const double force_x = size * (-u * u * std::cos(psi) + du * std::sin(psi));
    highest_z = std::max(highest_z, size * (u * u * std::sin(psi) + du * std::cos(psi)));
    highest_x = std::max(highest_x, force_x);
    lowest_x = std::min(lowest_x, force_x);
    mean_x += force_x / static_cast<double>(angles.size());
  }
  EXPECT_NEAR(highest_z, 13500.0, 50.0);
  EXPECT_LT(highest_x, 0.02 * -lowest_x) << "one sign, whereas the paper's figure 5 has both";
  EXPECT_LT(mean_x * kTwoPi / kPaperSpeed, -400.0) << "whereas the paper finds no impulse along x";
}

}  // namespace
}  // namespace hammer_loads::test
