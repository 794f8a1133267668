/// States on which every way to the loads is judged.
#pragma once

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/linkage/hull_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/util/constants.h"
#include "support/mo100.h"

namespace hammer_loads::test {

/// Angles of one machine under one speed, acceleration and gravity.
struct HardCase {
  std::string name;
  HammerParameters hammer;     ///< as given, the rod not corrected
  double speed{};              ///< [rad/s]
  double acceleration{};       ///< [rad/s2]
  Gravity gravity;             ///< [m/s2]
  std::vector<double> angles;  ///< in (0, 2 pi) [rad]; meant is exactly the number stored
};

inline const Gravity kCaseGravity{kStandardGravity * std::sin(0.3), kStandardGravity * -std::cos(0.3)};

/// Offsets 1e-first to 1e-last; side: +1 after, -1 before the blow.
inline std::vector<double> besideTheBlow(double side, int first, int last, std::initializer_list<double> digits) {
  std::vector<double> angles;
  for (int decade = first; decade <= last; ++decade) {
    for (const double digit : digits) {
      const double offset = digit * std::pow(10.0, -decade);
      angles.push_back(side > 0.0 ? offset : kTwoPi - offset);
    }
  }
  return angles;
}

inline HammerParameters scaled(HammerParameters p, double k) {
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
inline HammerParameters rounded(HammerParameters p) {
  for (double* length : {&p.lengths.crank, &p.lengths.rod, &p.lengths.rocker, &p.lengths.pivot_distance})
    *length = static_cast<double>(static_cast<float>(*length));
  return p;
}

/// Angles of a whole turn, evenly spaced, none at the blow.
inline std::vector<double> turnAngles(std::size_t count) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i)
    angles.push_back(kTwoPi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return angles;
}

/// The first is the regular turn, four are offsets of 1, 2.7 and 6.1 times 1e-1 to 1e-12 rad before and after the blow,
/// the others have both, coarser. P0's 31.416 rad/s and a hull pitched by 0.3 rad where nothing else is said.
inline std::vector<HardCase> hardCases(const HammerParameters& hammer) {
  const auto beside = [&](const char* name, double side, int first, int last) {
    return HardCase{name, hammer, kPaperSpeed, 0.0, kCaseGravity, besideTheBlow(side, first, last, {1.0, 2.7, 6.1})};
  };
  std::vector<double> everywhere = turnAngles(48);
  for (const double side : {-1.0, 1.0}) {
    const std::vector<double> near_blow = besideTheBlow(side, 1, 12, {2.7});
    everywhere.insert(everywhere.end(), near_blow.begin(), near_blow.end());
  }
  return {{"regular turn", hammer, kPaperSpeed, 0.0, kCaseGravity, turnAngles(240)},
          beside("before the blow, to 1e-6 rad", -1.0, 1, 6),
          beside("before, to 1e-12 rad", -1.0, 7, 12),
          beside("after the blow, to 1e-6 rad", 1.0, 1, 6),
          beside("after, to 1e-12 rad", 1.0, 7, 12),
          {"lengths rounded", rounded(hammer), kPaperSpeed, 0.0, kCaseGravity, everywhere},
          {"lengths x 1e-3", scaled(hammer, 1e-3), kPaperSpeed, 0.0, kCaseGravity, everywhere},
          {"lengths x 1e3", scaled(hammer, 1e3), kPaperSpeed, 0.0, kCaseGravity, everywhere},
          {"speed 0", hammer, 0.0, 0.0, kCaseGravity, everywhere},
          {"speed 1e-6 rad/s", hammer, 1e-6, 0.0, {}, everywhere},
          {"speed 1e3 rad/s", hammer, 1e3, 0.0, kCaseGravity, everywhere},
          {"acceleration 1e5 rad/s2", hammer, kPaperSpeed, 1e5, kCaseGravity, everywhere}};
}

}  // namespace hammer_loads::test
