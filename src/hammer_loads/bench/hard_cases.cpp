#include "hammer_loads/bench/hard_cases.h"

#include <cmath>
#include <initializer_list>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kPaperSpeed = 31.416;  // [rad/s], P0
const Gravity kGravity{kStandardGravity * std::sin(0.3), kStandardGravity * -std::cos(0.3)};

/// Offsets 1e-first to 1e-last; side: +1 after, -1 before the blow.
std::vector<double> besideTheBlow(double side, int first, int last, std::initializer_list<double> digits) {
  std::vector<double> angles;
  for (int decade = first; decade <= last; ++decade) {
    for (const double digit : digits) {
      const double offset = digit * std::pow(10.0, -decade);
      angles.push_back(side > 0.0 ? offset : kTwoPi - offset);
    }
  }
  return angles;
}

HammerParameters scaled(HammerParameters p, double k) {
  for (double* length :
       {&p.lengths.crank, &p.lengths.rod, &p.lengths.rocker, &p.lengths.pivot_distance, &p.rocker_com_distance,
        &p.striking_distance, &p.crank_com_along, &p.crank_com_across, &p.rod_com_along, &p.rod_com_across}) {
    *length *= k;
  }
  for (double* inertia :
       {&p.rocker_inertia_about_pivot, &p.crank_inertia_about_com, &p.rod_inertia_about_com, &p.drive_inertia}) {
    *inertia *= k * k;
  }
  return p;
}

/// Lengths as a file in single precision keeps them: the change-point condition is missed by some 1e-8 of the crank.
HammerParameters rounded(HammerParameters p) {
  for (double* length : {&p.lengths.crank, &p.lengths.rod, &p.lengths.rocker, &p.lengths.pivot_distance})
    *length = static_cast<double>(static_cast<float>(*length));
  return p;
}

}  // namespace

std::vector<double> turnAngles(std::size_t count) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i)
    angles.push_back(kTwoPi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return angles;
}

std::vector<HardCase> hardCases(const HammerParameters& hammer) {
  const auto beside = [&](const char* name, double side, int first, int last) {
    return HardCase{name, hammer, kPaperSpeed, 0.0, kGravity, besideTheBlow(side, first, last, {1.0, 2.7, 6.1})};
  };
  std::vector<double> everywhere = turnAngles(48);
  for (const double side : {-1.0, 1.0}) {
    const std::vector<double> near_blow = besideTheBlow(side, 1, 12, {2.7});
    everywhere.insert(everywhere.end(), near_blow.begin(), near_blow.end());
  }
  return {{"regular turn", hammer, kPaperSpeed, 0.0, kGravity, turnAngles(240)},
          beside("before the blow, to 1e-6 rad", -1.0, 1, 6),
          beside("before, to 1e-12 rad", -1.0, 7, 12),
          beside("after the blow, to 1e-6 rad", 1.0, 1, 6),
          beside("after, to 1e-12 rad", 1.0, 7, 12),
          {"lengths rounded", rounded(hammer), kPaperSpeed, 0.0, kGravity, everywhere},
          {"lengths x 1e-3", scaled(hammer, 1e-3), kPaperSpeed, 0.0, kGravity, everywhere},
          {"lengths x 1e3", scaled(hammer, 1e3), kPaperSpeed, 0.0, kGravity, everywhere},
          {"speed 0", hammer, 0.0, 0.0, kGravity, everywhere},
          {"speed 1e-6 rad/s", hammer, 1e-6, 0.0, {}, everywhere},
          {"speed 1e3 rad/s", hammer, 1e3, 0.0, kGravity, everywhere},
          {"acceleration 1e5 rad/s2", hammer, kPaperSpeed, 1e5, kGravity, everywhere}};
}

}  // namespace hammer_loads::accuracy
