/// Filter of one direction of the hull's motion, from its readings and the load that drives it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// A free hull responds to a load at once. Its acceleration is compliance times load plus a smooth part due to oil,
/// weight and rock, which changes no faster than boom and hull vibrate. A jump of the load, as at a blow, is a jump of
/// the acceleration. The smooth part is interpolated and predicted between readings.
///
/// Kalman filter with these states: integral of the signal (for a measured rate), smooth part, its slope (a random
/// walk), and three compliances. The smooth part is the force of the oil; its second derivative follows from the hull's
/// acceleration. Further states are therefore three stiffnesses and three dampings over inertia. The ratio of the
/// random walk's intensity to the noise is that of the likeliest candidate over some thousand readings. The noise is
/// estimated from the innovations, so that no sensor noise must be given.
class DrivenSignal {
 public:
  enum class Reads { kItself, kIntegral };

  struct Settings {
    Reads reads{};
    double noise{};  ///< first guess of the standard deviation, in the unit of the signal or of its integral
    /// Standard deviations of first guesses, which are zero. compliance: signal over force x, force z, moment.
    /// stiffness: second derivative of the signal over acceleration x, z, turning. damping: its first derivative over
    /// the same.
    Eigen::Vector3d compliance, stiffness, damping;
  };
  /// A short piece of time.
  struct Step {
    double length{};           ///< [s]
    Eigen::Vector3d impulse;   ///< impulse of the load, blows included
    Eigen::Vector3d velocity;  ///< change of the hull's velocity due to vibration: x, z, turning
    Eigen::Vector3d way;       ///< integral of that change from 0
  };
  /// Uncertain side of a blow, for a reading closer to it than the uncertainty of its instant. With this probability
  /// `added` is a part of the load (if the signal is measured) or of its impulse (if its integral is measured).
  struct UncertainSide {
    double probability{};
    Eigen::Vector3d added = Eigen::Vector3d::Zero();
  };
  struct Value {
    double signal{}, integral{};  ///< the integral is valid only where it is measured
    /// Variances and covariance of signal and integral.
    double signal_variance{}, covariance{}, integral_variance{};
  };

  static constexpr int kStates = 12;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  explicit DrivenSignal(const Settings& settings) noexcept;

  /// Sets the compliances of a robot description and the largest possible value of each. Their standard deviation is a
  /// part of the latter. The first description replaces the first guess. When the pose changes, identified values move
  /// by the difference of the descriptions.
  void expect(const Eigen::Vector3d& compliance, const Eigen::Vector3d& most) noexcept;
  /// Discards the motion, since readings do not continue the previous ones. The hull's constants are kept.
  void forgetMotion() noexcept { begun_ = false; }
  /// Reduces the weight of all previous readings in likelihoods and noise by this factor, since the load has grown.
  void outdate(double part) noexcept { counted_ *= part; }
  /// Returns true if all states and variances are finite.
  bool isFinite() const noexcept { return 0.0 * (best().x.sum() + best().P.sum()) == 0.0; }
  const Settings& settings() const noexcept { return settings_; }
  /// Predicts over a step after the last reading.
  void advance(const Step& step) noexcept;
  /// Updates with a reading at the present load. step: time since the last reading [s]. counts: the reading enters the
  /// likelihoods, as while the hammer works.
  void read(double reading, double step, const Eigen::Vector3d& load, const UncertainSide& uncertain_side,
            bool counts) noexcept;

  /// Change of the signal's integral over a future step, and the integral of that change from 0.
  struct Swing {
    double velocity{}, way{};
  };
  /// Prediction of the state beyond the last reading.
  class Future {
   public:
    explicit Future(const DrivenSignal& signal) noexcept : signal_(signal), x_(signal.best().x), P_(signal.best().P) {}
    /// Predicts over a step. The smooth part's slope acts for one interval of the readings.
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
  /// Returns the swing predicted by the best candidate.
  Swing swing(double length, const Eigen::Vector3d& impulse, const Eigen::Vector3d& lasting) const noexcept {
    return swing(best().x, length, impulse, lasting);
  }
  double noise() const noexcept;  ///< estimated noise of a reading
  Eigen::Vector3d compliance() const noexcept { return best().x.segment<3>(3); }
  Eigen::Vector3d complianceDeviation() const noexcept;
  /// Returns the mean square of the immediate response to loads with these mean squares, as far as the hull's mass is
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
  void update(double reading, const Eigen::Vector3d& load, const UncertainSide& uncertain_side, bool counts,
              Candidate& candidate) noexcept;
  void keepPrior(Candidate& candidate) const noexcept;
  double readOf(const State& x, const Eigen::Vector3d& load) const noexcept;  ///< H x: predicted reading
  double walkOf(const Candidate& candidate) const noexcept;
  const Candidate& best() const noexcept { return candidates_[best_]; }
  /// Returns the excess of the readings' variance at work over that at rest, due to motion too fast for the filter.
  double unfollowed() const noexcept {
    return std::max(0.0, best().variance - std::max(best().quiet, square(settings_.noise)));
  }

  Settings settings_;
  std::array<Candidate, kCandidates> candidates_;
  std::size_t best_{};
  Eigen::Vector3d expected_ = Eigen::Vector3d::Zero();  ///< compliances of the last expect()
  Prior prior_;        ///< variances of compliances, stiffnesses and dampings before any reading
  double interval_{};  ///< mean interval of the readings [s]
  double counted_{};
  double steady_{}, steady_time_{};  ///< mean of the measured signal; its time constant [s]
  bool begun_{};
};

}  // namespace hammer_loads
