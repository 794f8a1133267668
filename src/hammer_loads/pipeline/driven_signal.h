/// One direction of the hull's motion, followed from readings of it and the load that drives it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace hammer_loads {

/// A hull that is free to move answers to a load at once: its acceleration is compliance times load beside what oil,
/// weight and rock do, which changes no faster than boom and hull vibrate. So a jump of the load, as at a blow, is a
/// jump of the acceleration, and what is interpolated and foretold between readings is the smooth rest.
///
/// Kalman filter: integral of the signal (a rate that is read), the smooth part, its slope, which walks at random, and
/// three compliances, which are learned from all that the load does. How strongly the slope walks against the noise of a
/// reading is that of some candidates which foretells the readings best, and the noise is what these foretellings miss
/// (maximum likelihood over some thousand readings), so that no sensor's noise need be given.
///
/// Neglects: damping, by which an impulse makes the smooth part jump too (2 zeta omega of the velocity's jump).
class DrivenSignal {
 public:
  enum class Reads { kItself, kIntegral };

  struct Settings {
    Reads reads{};
    double noise{};              ///< first guess, standard: of the signal's unit or its integral's
    Eigen::Vector3d compliance;  ///< standard deviation of the first guess, which is zero [signal/N, N, N m]
  };
  struct Value {
    double signal{}, integral{};  ///< the integral only where it is read
    /// Of signal and integral.
    double signal_variance{}, covariance{}, integral_variance{};
  };

  explicit DrivenSignal(const Settings& settings) noexcept;

  /// Readings are not continuous with those before; what the hull is stays known.
  void forgetMotion() noexcept { begun_ = false; }
  /// step: since the last reading [s]; load at the reading; impulse: of the load since the last reading; counts: the
  /// readings show how the signal walks, as they do while the hammer works.
  void read(double reading, double step, const Eigen::Vector3d& load, const Eigen::Vector3d& impulse,
            bool counts) noexcept;
  /// So long after the last reading [s], at a load, with the impulse since then. The smooth part's slope counts for one
  /// interval of the readings.
  Value foretell(double step, const Eigen::Vector3d& load, const Eigen::Vector3d& impulse) const noexcept;
  double noise() const noexcept;  ///< of a reading, as learned
  Eigen::Vector3d compliance() const noexcept { return best().x.tail<3>(); }
  Eigen::Vector3d complianceDeviation() const noexcept;

 private:
  using State = Eigen::Matrix<double, 6, 1>;
  using Covariance = Eigen::Matrix<double, 6, 6>;
  /// The covariance is in units of the noise's variance.
  struct Candidate {
    double walk{};  ///< of the slope, intensity over the noise's variance, in units of the reading's interval
    State x;
    Covariance P;
    double variance{}, log_spread{};  ///< of a reading; mean logarithm of what it was foretold with
    double score() const noexcept;
  };
  static constexpr std::size_t kCandidates = 4;

  void begin(double reading, const Eigen::Vector3d& load) noexcept;
  void advance(double step, double slope_step, const Eigen::Vector3d& impulse, double walk, State& x,
               Covariance& P) const noexcept;
  void update(double reading, const Eigen::Vector3d& load, bool counts, Candidate& candidate) noexcept;
  State rowOf(const Eigen::Vector3d& load) const noexcept;
  double walkOf(const Candidate& candidate) const noexcept;
  const Candidate& best() const noexcept { return candidates_[best_]; }

  Settings settings_;
  std::array<Candidate, kCandidates> candidates_;
  std::size_t best_{};
  double interval_{};  ///< mean, of the readings [s]
  double counted_{};
  bool begun_{};
};

}  // namespace hammer_loads
