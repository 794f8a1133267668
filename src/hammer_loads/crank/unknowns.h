/// Table of the uncertain constants of crank sensor and drive, one row each, which contains all that the filter needs.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "hammer_loads/crank/supply.h"
#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {

/// Place of a reading on the shaft of the encoder.
struct ReadingPlace {
  double offset{};        ///< from the blow, within half a turn [rad]
  double speed{};         ///< [rad/s]
  double acceleration{};  ///< [rad/s2]
};

/// sin and cos within 0.1 %, |x| <= 3/4 of a turn: two parabolas.
constexpr double roughSine(double x) noexcept {
  const double part = x * (2.0 / kTwoPi), y = 4.0 * part * (1.0 - (part < 0.0 ? -part : part));
  return y * (0.775 + 0.225 * (y < 0.0 ? -y : y));
}
constexpr double roughCosine(double x) noexcept { return roughSine(0.25 * kTwoPi - (x < 0.0 ? -x : x)); }

/// The error p of one constant: its prior, and its effect on readings and torque.
struct Unknown {
  enum class Use {
    kSeen,        ///< estimated from the innovations; not corrected, but reported and included in the deviations
    kTakenUp,     ///< estimated from the innovations, separately; its owner corrects the constant
    kConsidered,  ///< considered with its prior, not estimated
  };
  const char* name;  ///< name of its warning; adjacent rows of one name are one amount, root of their squares
  const char* key;   ///< key in the parameter file
  Use use;
  double prior;                                        ///< default standard deviation
  double unmodelled;                                   ///< standard deviation that a clean machine shows: kSeen
  double (*of_angle)(const ReadingPlace&);             ///< d(read angle)/dp
  double (*of_speed)(const ReadingPlace&);             ///< d(read speed)/dp
  double (*of_torque)(const SupplyLaw&, double lead);  ///< d(the filter's torque after a step less before it)/dp
  double notable;                                      ///< threshold of the warning
  std::string (*warning)(double amount, double deviation);
  bool of_reading{};  ///< true if its key is a reading's: the amount there is that of the crank's angle over the
                      ///< sensor's gain
};

namespace unknown {

inline constexpr double kDegree = kTwoPi / 360.0;

inline double notOfReading(const ReadingPlace&) { return 0.0; }
inline double notOfTorque(const SupplyLaw&, double) { return 0.0; }

inline std::string ofZero(double amount, double deviation) {
  return format(
      "crank_zero_rad: the readings look as if the blow came at %.2g rad (%.2g deg, deviation "
      "%.1g deg) more than given; a tool met before the dead centre or a supply without oil "
      "compliance looks alike: run calibrate",
      amount, amount / kDegree, deviation / kDegree);
}
inline std::string ofEccentricity(double amount, double deviation) {
  return format(
      "crank encoder: looks eccentric by %.2g deg (crank_eccentricity_1_rad: %.2g rad, "
      "deviation %.1g deg) more than given: run calibrate",
      amount / kDegree, amount, deviation / kDegree);
}

}  // namespace unknown

/// Table of the constants; those of kSeen are first. Readings of the sensor's place: angle + b0 + b1 sin(angle) + b2
/// (cos(angle) - 1) [rad], so that b0 alone shows where the blow is. Clean machines show 0.10, 0.11 and 0.23 deg of
/// these; from 0.3 and 0.5 deg on the wrench is some 0.9 % worse. The priors of the speed rows are those of a drive
/// that filters; with a quarter of them the error in the first second of a lag of 10 ms would be twice the allowed one.
inline constexpr std::array<Unknown, 7> kUnknowns{{
    {"zero", "crank_zero_rad", Unknown::Use::kSeen, 0.05, 1.7e-3, [](const ReadingPlace&) { return 1.0; },
     unknown::notOfReading, unknown::notOfTorque, 0.3 * unknown::kDegree, unknown::ofZero, true},
    {"eccentricity", "crank_eccentricity_1_rad", Unknown::Use::kSeen, 0.05, 2e-3,
     [](const ReadingPlace& at) { return roughSine(at.offset); },
     [](const ReadingPlace& at) { return at.speed * roughCosine(at.offset); }, unknown::notOfTorque,
     0.5 * unknown::kDegree, unknown::ofEccentricity},
    {"eccentricity", "crank_eccentricity_1_rad", Unknown::Use::kSeen, 0.05, 4e-3,
     [](const ReadingPlace& at) { return roughCosine(at.offset) - 1.0; },
     [](const ReadingPlace& at) { return -at.speed * roughSine(at.offset); }, unknown::notOfTorque,
     0.5 * unknown::kDegree, unknown::ofEccentricity},
    {"supply", nullptr, Unknown::Use::kTakenUp, 0.2, 0.0, unknown::notOfReading, unknown::notOfReading,
     [](const SupplyLaw& supply, double lead) { return -supply.unit * lead; }, 0.0, nullptr},
    {"latency", "crank_latency_s", Unknown::Use::kConsidered, 0.0, 0.0,
     [](const ReadingPlace& at) { return -at.speed; }, [](const ReadingPlace& at) { return -at.acceleration; },
     unknown::notOfTorque, 0.0, nullptr},
    {"speed lag", nullptr, Unknown::Use::kConsidered, 4e-3, 0.0, unknown::notOfReading,
     [](const ReadingPlace& at) { return -at.acceleration; }, unknown::notOfTorque, 0.0, nullptr},
    {"speed scale", nullptr, Unknown::Use::kConsidered, 0.04, 0.0, unknown::notOfReading,
     [](const ReadingPlace& at) { return at.speed; }, unknown::notOfTorque, 0.0, nullptr},
}};

/// Number of constants that are seen; they come first.
constexpr int countSeen() noexcept {
  int count = 0;
  for (const Unknown& u : kUnknowns) count += u.use == Unknown::Use::kSeen;
  return count;
}
/// Index in the table; an unknown name does not compile where the index is needed at compile time.
constexpr int indexOfUnknown(const char* name) {
  std::size_t i = 0;
  for (bool found = false; i < kUnknowns.size() && !found; i += !found) {
    const char *a = kUnknowns[i].name, *b = name;
    while (*a != '\0' && *a == *b) ++a, ++b;
    found = *a == *b;
  }
  return i < kUnknowns.size() ? static_cast<int>(i) : throw "no such unknown";  // in one expression, for GCC 9
}

}  // namespace hammer_loads
