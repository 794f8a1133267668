#include "hammer_loads/boom/mode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <random>
#include <vector>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

/// Returns the responses to impulse, step, ramp and parabola by closed forms in 50 digits.
std::array<double, 4> exactResponse(const Mode& mode, double time) {
  const Exact w = mode.omega, zeta = mode.zeta, t = time;
  const Exact root = sqrt(1 - zeta * zeta), decay = exp(-zeta * w * t);
  const Exact s = sin(root * w * t), c = cos(root * w * t);
  const Exact impulse = decay * s / (root * w);
  const Exact step = (1 - decay * (c + zeta / root * s)) / (w * w);
  const Exact ramp = (t - 2 * zeta * w * step - impulse) / (w * w);
  const Exact parabola = (t * t / 2 - 2 * zeta * w * ramp - step) / (w * w);
  return {impulse.convert_to<double>(), step.convert_to<double>(), ramp.convert_to<double>(),
          parabola.convert_to<double>()};
}

TEST(ModeResponse, EqualsFiftyDigitsForEveryStep) {
  double worst = 0.0;
  for (double zeta : {0.0, 1e-3, 0.05, 0.4, 0.95}) {
    for (double wt = 1e-6; wt < 500.0; wt *= 1.37) {
      const Mode mode{23.7, zeta};
      const double t = wt / mode.omega;
      const ModeResponse got = responseAt(mode, t);
      const auto expected = exactResponse(mode, t);
      // Size: what the same would be without the swinging parts.
      const std::array<double, 4> value{got.impulse, got.step, got.ramp, got.parabola};
      const double w = mode.omega;
      const std::array<double, 4> size{std::min(t, 1.0 / w), std::min(t * t / 2.0, 1.0 / (w * w)),
                                       std::min(t * t * t / 6.0, t / (w * w)),
                                       std::min(std::pow(t, 4) / 24.0, t * t / (2.0 * w * w))};
      for (std::size_t i = 0; i < 4; ++i) {
        // The argument of sine and cosine has an error of half an ulp of wt.
        const double tolerance = (wt > 1.0 ? 8.0 + wt : 8.0) * 2.3e-16;
        const double error = std::abs(value[i] - expected[i]) / size[i];
        EXPECT_LT(error, 4.0 * tolerance) << "zeta " << zeta << " wt " << wt << " term " << i;
        if (wt <= 10.0) worst = std::max(worst, error);
      }
    }
  }
  RecordProperty("worst", format("%.2g", worst));
}

TEST(ModeResponse, FreeJointHasNoFrequency) {
  const ModeResponse r = responseAt({0.0, 0.05}, 3.0);
  EXPECT_DOUBLE_EQ(r.impulse, 3.0);
  EXPECT_DOUBLE_EQ(r.step, 4.5);
  EXPECT_DOUBLE_EQ(r.ramp, 4.5);
  EXPECT_DOUBLE_EQ(r.parabola, 3.375);
}

/// Returns Duhamel's integral by Gauss-Legendre: int f(s) e^(-zeta w (t - s)) sin(root w (t - s))/(root w) ds.
double duhamel(const Mode& mode, double mu, double t) {
  static const std::array<double, 8> node{0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                                          0.6178762444026437484, 0.7554044083550030338, 0.8656312023878317438,
                                          0.9445750230732325760, 0.9894009349916499325};
  static const std::array<double, 8> weight{0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382,
                                            0.1495959888165767320, 0.1246289712555338720, 0.0951585116824927848,
                                            0.0622535239386478929, 0.0271524594117540949};
  const double end = std::min(t, kPi / mu), root = std::sqrt(1.0 - mode.zeta * mode.zeta);
  constexpr int kPanels = 40;
  long double sum = 0.0L;
  for (int p = 0; p < kPanels; ++p) {
    const double middle = end * (p + 0.5) / kPanels, half = 0.5 * end / kPanels;
    for (std::size_t i = 0; i < 8; ++i) {
      for (double side : {-1.0, 1.0}) {
        const double s = middle + side * half * node[i];
        sum += half * weight[i] * std::sin(mu * s) * std::exp(-mode.zeta * mode.omega * (t - s)) *
               std::sin(root * mode.omega * (t - s)) / (root * mode.omega);
      }
    }
  }
  return static_cast<double>(sum);
}

TEST(HalfSine, ClosedFormEqualsDuhamelsIntegral) {
  double worst = 0.0;
  for (double omega : {3.0, 25.0, 160.0, 168.0, 700.0}) {
    const Mode mode{omega, 0.05};
    const double mu = 168.0, length = kPi / mu;
    double peak = 0.0;
    std::vector<double> error;
    for (double t = 0.02 * length; t < 4.0 * length; t += 0.06 * length) {
      const double got = halfSineResponse(mode, 1.0, mu, t).x;
      peak = std::max(peak, std::abs(got));
      error.push_back(std::abs(got - duhamel(mode, mu, t)));
    }
    worst = std::max(worst, *std::max_element(error.begin(), error.end()) / peak);
  }
  RecordProperty("worst", format("%.2g", worst));
  EXPECT_LT(worst, 1e-12);
}

double energy(const Mode& mode, const ModeState& s) { return 0.5 * (s.v * s.v + mode.omega * mode.omega * s.x * s.x); }

TEST(ModeAdvance, EnergyNeverGrowsWithoutForceWhateverTheStep) {
  std::mt19937 random(32);
  std::uniform_real_distribution<> between(-1.0, 1.0);
  for (double zeta : {1e-4, 0.01, 0.05, 0.7}) {
    for (int i = 0; i < 200; ++i) {
      const Mode mode{std::exp(3.0 * between(random) + 2.0), zeta};
      ModeState state{between(random), mode.omega * between(random)};
      double before = energy(mode, state);
      for (int k = 0; k < 300; ++k) {
        const double h = std::exp(9.0 * between(random)) / mode.omega;  // 1e-4 to 8000 radians
        state = advanced(mode, state, {}, h);
        const double now = energy(mode, state);
        ASSERT_LE(now, before * (1.0 + 4.0 * 2.3e-16) + 1e-300);
        before = now;
      }
    }
  }
}

}  // namespace
}  // namespace hammer_loads
