/// Grapples for the tests: the two reconstructed sets, and random linkages of the same topology.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "hammer_loads/grapple/branches.h"
#include "hammer_loads/grapple/grapple.h"
#include "hammer_loads/grapple/grapple_settings.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::test {

inline std::string shippedFile(const std::string& name) {
  return std::string(HAMMER_LOADS_TEST_DATA) + "/../../config/" + name;
}

/// Returns the ten published lengths with the angles fitted to the paper's claims.
inline GrappleParameters claimsParameters() {
  return loadGrapple({shippedFile("grapple_claims.yaml")}).value.value().parameters();
}

/// Returns the ten published lengths with the angles fitted to the straightest path.
inline GrappleParameters straightParameters() {
  return loadGrapple({shippedFile("grapple_straight.yaml")}).value.value().parameters();
}

inline Grapple grappleOf(const GrappleParameters& parameters) {
  const Checked<Grapple> grapple = Grapple::make(parameters);
  for (const std::string& problem : grapple.problems) ADD_FAILURE() << problem;
  return grapple.value.value();
}

/// Uniform in [0, 1) with the same numbers on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool coin() { return (engine_() >> 63) != 0; }

 private:
  std::mt19937_64 engine_;
};

/// Draws any lengths and angles, without regard to a working machine; stroke and reference are not set.
inline GrappleParameters randomLinkage(Random& random) {
  GrappleParameters p;
  p.o1 = {random(-1.5, 1.5), random(-1.5, 1.5)};
  p.slider_x = random(-0.5, 0.5);
  p.o1h = random(0.3, 1.5);
  p.gh = random(0.3, 1.5);
  p.o1a = random(0.5, 2.0);
  p.ho1a = random(-kPi, kPi);
  p.drive_sign = random.coin() ? 1 : -1;
  p.ab = random(0.3, 2.5);
  p.ac = random(0.3, 2.5);
  p.bac = random(-kPi, kPi);
  p.bd = random(0.3, 2.5);
  p.bp = random(0.3, 2.5);
  p.dbp = random(-kPi, kPi);
  p.ce = random(0.3, 2.5);
  p.od = random(0.3, 2.5);
  p.oe = random(0.3, 2.5);
  p.doe = random(-kPi, kPi);
  return p;
}

/// Returns a linkage with six modes at theta1 = 0.4 rad.
inline GrappleParameters sixModeLinkage() {
  GrappleParameters p;
  p.o1 = {1.3, -1.3};
  p.o1a = 0.9;
  p.ab = 1.7;
  p.ac = 1.9;
  p.bac = -1.4;
  p.bd = 2.3;
  p.bp = 1.0;
  p.ce = 2.3;
  p.od = 1.7;
  p.oe = 2.0;
  p.doe = 1.4;
  return p;
}

/// Returns the difference of two angles modulo whole revolutions [rad].
inline double apart(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); }

/// Draws a random linkage in one of its poses at a random slider position, with a very short stroke there. About one
/// draw in ten assembles.
inline std::optional<Grapple> randomGrapple(Random& random) {
  constexpr double kStroke = 1e-5;
  GrappleParameters p = randomLinkage(random);
  p.reference_slider = p.o1.im + random(-2.5, 2.5);
  const auto drive = SliderDrive(p).at(p.reference_slider);
  if (!drive) return std::nullopt;
  const Planar a = p.o1 + (p.o1a / p.o1h) * (drive->o1h * direction(-p.ho1a));
  const Branches all = enumerateBranches(LeverGroup(p), a);
  if (all.count == 0) return std::nullopt;
  const auto& branch = all.branch[static_cast<std::size_t>(random(0.0, all.count))];
  p.reference_ab = branch.theta2;
  p.reference_od = branch.theta5;
  for (const double side : {1.0, -1.0}) {
    p.slider_closed = p.reference_slider - side * kStroke;
    p.slider_open = p.reference_slider + side * kStroke;
    const Checked<Grapple> grapple = Grapple::make(p);
    if (grapple.value) return grapple.value;
  }
  return std::nullopt;
}

}  // namespace hammer_loads::test
