#include "hammer_loads/grapple/branches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr int kSamples = 8;  ///< > 6: a polynomial of degree 3 in cos and sin needs seven
constexpr double kNearlyReal =
    1e-4;                           ///< |Im tan(alpha/2)| of a root that may be real: a double root splits by sqrt(eps)
constexpr double kParallel = 1e-6;  ///< |w1 x w2|/(|w1||w2|) below which the linear equations do not determine O
constexpr double kNoLength = 1e-6;  ///< |w| relative to the group's size that counts as zero
constexpr double kBesideSelfMotion = 1e-2;  ///< [rad]: the quadruple root splits by the fourth root of rounding
constexpr double kSamePose = 1e-6;          ///< [rad]
constexpr int kPolishing = 50;              ///< Newton steps: at a double root each halves the error only

/// e(2 pi j/8); any j.
std::complex<double> unitRoot(int j) {
  constexpr double kHalfSqrt = 0.70710678118654752440;
  constexpr std::array<double, kSamples> kCos = {1.0, kHalfSqrt, 0.0, -kHalfSqrt, -1.0, -kHalfSqrt, 0.0, kHalfSqrt};
  const auto wrapped = [](int i) { return static_cast<std::size_t>(i & (kSamples - 1)); };
  return {kCos[wrapped(j)], kCos[wrapped(j - kSamples / 4)]};
}

/// The two linear equations for O seen from link 2 with AB along +x: w1 . o = k1, w2 . o = k2.
struct LinearPair {
  Planar w1, w2;
  double k1, k2;
};

LinearPair linearPair(const LeverGroup& group, double distance_squared, Planar alpha) {
  const GroupShape& g = group.shape();
  const Planar d = g.od * alpha;
  LinearPair l;
  l.w1 = d - Planar{g.ab, 0.0};
  l.w2 = d * g.e_by_od - g.ab * g.c_by_ab;
  l.k1 = 0.5 * (g.bd * g.bd - distance_squared - squaredNorm(l.w1));
  l.k2 = 0.5 * (g.ce * g.ce - distance_squared - squaredNorm(l.w2));
  return l;
}

/// (w1 x w2)^2 (|o|^2 - |OA|^2) with o from Cramer's rule: zero at a pose; degree 3 in alpha.
double distanceEquation(const LinearPair& l, double distance_squared) {
  const double x = l.k1 * l.w2.im - l.k2 * l.w1.im;
  const double y = l.w1.re * l.k2 - l.w2.re * l.k1;
  const double determinant = cross(l.w1, l.w2);
  return x * x + y * y - distance_squared * determinant * determinant;
}

using Roots = Eigen::Matrix<std::complex<double>, 6, 1>;

/// Roots t of F(alpha)(1 + t^2)^3 with alpha = alpha0 + 2 atan t, from samples of F at multiples of 2 pi/8; alpha0 is
/// opposite the largest sample, so that the leading coefficient is that sample. False if F vanishes everywhere.
bool halfAngleRoots(const std::array<double, kSamples>& samples, double scale, double& alpha0, Roots& roots) {
  const auto largest =
      std::max_element(samples.begin(), samples.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  if (!(std::abs(*largest) > scale)) return false;
  const int j0 = static_cast<int>(largest - samples.begin()) + kSamples / 2;
  alpha0 = kTwoPi / kSamples * j0;

  // Fourier coefficients about alpha0: F = sum over k = -3..3 of h_k e(k (alpha - alpha0)), h_-k = conj h_k.
  std::array<std::complex<double>, 4> h{};
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < kSamples; ++j) {
      h[static_cast<std::size_t>(k)] += samples[static_cast<std::size_t>(j)] / kSamples * unitRoot(-k * (j - j0));
    }
  }
  // e(k (alpha - alpha0)) (1 + t^2)^3 = (1 + it)^(3+k) (1 - it)^(3-k), expanded.
  const double h0 = h[0].real();
  const std::complex<double> h1 = 2.0 * h[1], h2 = 2.0 * h[2], h3 = 2.0 * h[3];
  const std::array<double, 7> p = {h0 + h1.real() + h2.real() + h3.real(),
                                   -2.0 * h1.imag() - 4.0 * h2.imag() - 6.0 * h3.imag(),
                                   3.0 * h0 + h1.real() - 5.0 * h2.real() - 15.0 * h3.real(),
                                   -4.0 * h1.imag() + 20.0 * h3.imag(),
                                   3.0 * h0 - h1.real() - 5.0 * h2.real() + 15.0 * h3.real(),
                                   -2.0 * h1.imag() + 4.0 * h2.imag() - 6.0 * h3.imag(),
                                   h0 - h1.real() + h2.real() - h3.real()};
  Eigen::Matrix<double, 6, 6> companion = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < 6; ++i) companion(i, 5) = -p[static_cast<std::size_t>(i)] / p[6];
  for (int i = 0; i < 5; ++i) companion(i + 1, i) = 1.0;
  const Eigen::EigenSolver<Eigen::Matrix<double, 6, 6>> solver(companion, false);
  roots = solver.eigenvalues();
  return solver.info() == Eigen::Success;
}

class Collector {
 public:
  Collector(const LeverGroup& group, Planar a) : group_(group), a_(a), distance_squared_(squaredNorm(a)) {
    const GroupShape& g = group.shape();
    size_ = std::max({g.ab, g.od, g.ab * norm(g.c_by_ab), g.od * norm(g.e_by_od)});
  }

  /// With AB = OD, AC = OE and equal angles both equations vanish at alpha = 0: then O may be anywhere on its circle.
  void findSelfMotion() {
    const LinearPair l = linearPair(group_, distance_squared_, {1.0, 0.0});
    result.self_motion = norm(l.w1) < kNoLength * size_ && norm(l.w2) < kNoLength * size_ &&
                         std::abs(l.k1) < kNoLength * size_ * size_ && std::abs(l.k2) < kNoLength * size_ * size_;
  }

  void collectAt(double alpha) {
    if (result.self_motion && std::abs(std::remainder(alpha, kTwoPi)) < kBesideSelfMotion) return;
    const LinearPair l = linearPair(group_, distance_squared_, direction(alpha));
    const double determinant = cross(l.w1, l.w2);
    const double n1 = norm(l.w1), n2 = norm(l.w2);
    if (std::abs(determinant) > kParallel * n1 * n2) {
      const Planar o{l.k1 * l.w2.im - l.k2 * l.w1.im, l.w1.re * l.k2 - l.w2.re * l.k1};
      polish((1.0 / determinant) * o, alpha);
      return;
    }
    Planar w = n1 > n2 ? l.w1 : l.w2;
    const double along = (n1 > n2 ? l.k1 : l.k2) / squaredNorm(w);
    const double across = std::sqrt(std::max(distance_squared_ / squaredNorm(w) - along * along, 0.0));
    polish(along * w + across * turned(w), alpha);
    polish(along * w - across * turned(w), alpha);
  }

  Branches result;

 private:
  /// o: from A to O seen from link 2.
  void polish(Planar o, double alpha) {
    const double theta2 = angleOf(-a_) - angleOf(o);
    GroupPose pose = group_.pose(a_, theta2, theta2 + alpha);
    Closure closure;
    if (!group_.solve(a_, kPolishing, pose, closure) || result.count == 6) return;
    const Branches::Branch found{std::remainder(pose.theta2, kTwoPi), std::remainder(pose.theta5, kTwoPi),
                                 closure.determinant};
    for (int i = 0; i < result.count; ++i) {
      const Branches::Branch& other = result.branch[static_cast<std::size_t>(i)];
      const bool same_side = std::signbit(other.determinant) == std::signbit(found.determinant);
      if (same_side && std::abs(std::remainder(other.theta2 - found.theta2, kTwoPi)) < kSamePose &&
          std::abs(std::remainder(other.theta5 - found.theta5, kTwoPi)) < kSamePose)
        return;
    }
    result.branch[static_cast<std::size_t>(result.count++)] = found;
  }

  const LeverGroup& group_;
  const Planar a_;
  double distance_squared_, size_;
};

}  // namespace

Branches enumerateBranches(const LeverGroup& group, Planar a) noexcept {
  const double distance_squared = squaredNorm(a);
  std::array<double, kSamples> samples{};
  double scale = 0.0;
  for (int j = 0; j < kSamples; ++j) {
    const LinearPair l = linearPair(group, distance_squared, {unitRoot(j).real(), unitRoot(j).imag()});
    samples[static_cast<std::size_t>(j)] = distanceEquation(l, distance_squared);
    const double w = std::max(norm(l.w1), norm(l.w2)), k = std::max(std::abs(l.k1), std::abs(l.k2));
    scale = std::max(scale, w * w * std::max(k * k, distance_squared * w * w));
  }
  Collector collector(group, a);
  double alpha0 = 0.0;
  Roots roots;
  if (!halfAngleRoots(samples, 1e-13 * scale, alpha0, roots)) {
    collector.result.self_motion = true;
    return collector.result;
  }
  collector.findSelfMotion();
  for (Eigen::Index i = 0; i < roots.size(); ++i) {  // Eigen 3.3 has no begin()
    const std::complex<double> t = roots[i];
    if (!(std::abs(t.imag()) <= kNearlyReal * (1.0 + std::norm(t)))) continue;
    // A double root comes as a conjugate pair: its two members start on either side.
    collector.collectAt(alpha0 + 2.0 * std::atan(t.real() + t.imag()));
  }
  return collector.result;
}

}  // namespace hammer_loads
