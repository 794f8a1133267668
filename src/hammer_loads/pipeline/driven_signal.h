/// Filter of one direction of the hull's motion, from its readings and the load that drives it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// A free hull responds to a load at once: its acceleration is compliance times load plus a smooth part by oil, weight
/// and rock, which changes no faster than boom and hull vibrate. A jump of the load, as at a blow, is therefore a jump
/// of the acceleration, and the smooth part is interpolated and predicted between readings.
///
/// Kalman filter with these states: integral of the signal (for a measured rate), the smooth part, its slope (a random
/// walk), and three compliances. The smooth part is the force of the oil, whose second derivative follows from the
/// hull's acceleration: three stiffnesses and three dampings over inertia are further states. The intensity of the
/// random walk over the noise of a reading is the candidate with the largest likelihood over some thousand readings,
/// and the noise is estimated from the innovations, so that no noise of the sensor must be given.
class DrivenSignal {
 public:
  enum class Reads { kItself, kIntegral };

  struct Settings {
    Reads reads{};
    double noise{};  ///< first guess, standard: of the signal's unit or its integral's
    /// Standard deviations of first guesses, which are zero: signal over force x, force z, moment; second derivative
    /// of the signal over acceleration x, z, turning; its first derivative over the same.
    Eigen::Vector3d compliance, stiffness, damping;
  };
  /// A short piece of time.
  struct Step {
    double length{};           ///< [s]
    Eigen::Vector3d impulse;   ///< impulse of the load, blows included
    Eigen::Vector3d velocity;  ///< change of the hull's velocity by vibration: x, z, turning
    Eigen::Vector3d way;       ///< the integral of that from 0
  };
  /// A reading closer to a blow than the uncertainty of its instant: with this probability, `added` is a part of the
  /// load (if the signal is measured) or of its impulse (if its integral is measured).
  struct Doubt {
    double probability{};
    Eigen::Vector3d added = Eigen::Vector3d::Zero();
  };
  struct Value {
    double signal{}, integral{};  ///< the integral only where it is read
    /// Variances and covariance of signal and integral.
    double signal_variance{}, covariance{}, integral_variance{};
  };

  static constexpr int kStates = 12;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  explicit DrivenSignal(const Settings& settings) noexcept;

  /// Sets the compliances of a robot description and the most that each can be; their standard deviation is a part of
  /// that. The first description replaces the first guess. From one to the next, as the pose changes, the identified
  /// values move by the difference of the descriptions.
  void expect(const Eigen::Vector3d& compliance, const Eigen::Vector3d& most) noexcept;
  /// Forgets the motion, as readings do not continue those before; the hull's constants are kept.
  void forgetMotion() noexcept { begun_ = false; }
  /// Reduces the weight of all readings so far in the likelihoods and the noise by that factor, since the load has
  /// grown.
  void outdate(double part) noexcept { counted_ *= part; }
  /// Returns true if all states and variances are finite.
  bool isFinite() const noexcept { return 0.0 * (best().x.sum() + best().P.sum()) == 0.0; }
  const Settings& settings() const noexcept { return settings_; }
  /// Predicts over a step after the last reading.
  void advance(const Step& step) noexcept;
  /// Updates by a reading at the present load. step: time since the last reading [s]; counts: the reading counts for
  /// the likelihoods, as it does while the hammer works.
  void read(double reading, double step, const Eigen::Vector3d& load, const Doubt& doubt, bool counts) noexcept;

  /// Change of the signal's integral over a step to come, and the integral of that from 0.
  struct Swing {
    double velocity{}, way{};
  };
  /// Prediction of the state beyond the last reading.
  class Future {
   public:
    explicit Future(const DrivenSignal& signal) noexcept : signal_(signal), x_(signal.best().x), P_(signal.best().P) {}
    /// The smooth part's slope counts for one interval of the readings.
    void advance(const Step& step) noexcept;
    Value at(const Eigen::Vector3d& load) const noexcept;
    Swing swing(double length, const Eigen::Vector3d& impulse, const Eigen::Vector3d& lasting) const noexcept {
      return signal_.swing(x_, length, impulse, lasting);
    }

   private:
    const DrivenSignal& signal_;
    State x_;
    Covariance P_;
    double since_{};
  };
  /// Swing by the best candidate.
  Swing swing(double length, const Eigen::Vector3d& impulse, const Eigen::Vector3d& lasting) const noexcept {
    return swing(best().x, length, impulse, lasting);
  }
  double noise() const noexcept;  ///< learned noise of a reading
  Eigen::Vector3d compliance() const noexcept { return best().x.segment<3>(3); }
  Eigen::Vector3d complianceDeviation() const noexcept;
  /// Mean square of the immediate response of the signal to loads of these mean squares, as far as the hull's mass is
  /// known.
  double yielding(const Eigen::Vector3d& load_square) const noexcept {
    return load_square.dot(compliance().cwiseAbs2() + complianceDeviation().cwiseAbs2());
  }

 private:
  /// The covariance is in units of the noise's variance.
  struct Candidate {
    double walk{};  ///< intensity of the slope's random walk over the variance of the noise, in units of the readings'
                    ///< interval
    State x;
    Covariance P;
    double variance{}, log_spread{};  ///< variance of a reading; mean logarithm of its predicted variance
    double quiet{};                   ///< variance of a reading at rest
    double score() const noexcept;
  };
  static constexpr std::size_t kCandidates = 4;
  using Prior = Eigen::Matrix<double, 9, 1>;

  void begin(double reading, const Eigen::Vector3d& load) noexcept;
  void carry(const Step& step, double slope_step, double walk, double unit, State& x, Covariance& P) const noexcept;
  Swing swing(const State& x, double length, const Eigen::Vector3d& impulse,
              const Eigen::Vector3d& lasting) const noexcept;
  void update(double reading, const Eigen::Vector3d& load, const Doubt& doubt, bool counts,
              Candidate& candidate) noexcept;
  void keepPrior(Candidate& candidate) const noexcept;
  double readOf(const State& x, const Eigen::Vector3d& load) const noexcept;  ///< H x: what a reading is of that
  double walkOf(const Candidate& candidate) const noexcept;
  const Candidate& best() const noexcept { return candidates_[best_]; }
  /// Excess of the readings' variance at work over that at rest, by motion that is too fast for the filter.
  double unfollowed() const noexcept {
    return std::max(0.0, best().variance - std::max(best().quiet, square(settings_.noise)));
  }

  Settings settings_;
  std::array<Candidate, kCandidates> candidates_;
  std::size_t best_{};
  Eigen::Vector3d expected_ = Eigen::Vector3d::Zero();  ///< compliances, by the last expect()
  Prior prior_;        ///< variances of compliances, stiffnesses and dampings before any reading
  double interval_{};  ///< mean, of the readings [s]
  double counted_{};
  double steady_{}, steady_time_{};  ///< mean of the signal that is read; over [s]
  bool begun_{};
};

}  // namespace hammer_loads
