/// Kalman filter on crank and rocker as two bodies with the rod as a spring, around a blow.
#pragma once

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/gaussian_belief.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/two_bodies.h"

namespace hammer_loads {

/// State and parameters that determine the motion around a blow.
struct RodMotion {
  TwoBodyState state;
  double torque{};       ///< net torque on the crank [N m]
  double inertia{};      ///< Jc [kg m2]
  double restitution{};  ///< restitution of the rocker on the tool [-]
  RodSpring rod;
  double place{};  ///< psi at contact with the tool, including the depth of the contact [rad]
};

/// The crank before the blow is estimated with a rigid mechanism; the rod's spring matters from some 15 ms before it
/// until half a revolution later. The filter begins there with the belief of the crank's filter. Stiffness, damping and
/// restitution are identified from blow to blow: the readings contain little information on the vibration of one blow,
/// but enough on that of ten.
///
/// Extended Kalman filter, linearised by differences: for each independent error (a column of the covariance's root) a
/// perturbed machine is integrated in parallel.
///
/// Friction is identified with tight pins alone, since impacts in worn pins resemble it. Pins do not exactly follow
/// Coulomb's law. The rest disturbs both bodies as white noise of the spectral density 2 T (r N)^2, with r a part of
/// the friction radius and of its standard deviation; N is the rod's greatest force of the last T.
class RodFilter {
 public:
  /// Rows of the state; inertia, stiffness and damping ratio as logarithms.
  enum Row : Eigen::Index {
    kAngle,
    kSpeed,
    kDisplacement,
    kDisplacementRate,
    kTorque,
    kInertia,
    kStiffness,
    kDamping,
    kPlay,
    kFriction,
    kRestitution,  ///< from here on: rows that matter at the tool alone
    kPlace,
    kSize
  };
  using Belief = GaussianBelief<kSize, 0>;

  /// Tight pins transmit tension and compression; pins with joint clearance can only push.
  enum class Pins { kTight, kPlay };
  /// Refers to the mechanism, which must outlive it. A value of 0 in its RodSpring is replaced by a first guess.
  RodFilter(const Mechanism& mechanism, Pins pins) noexcept;

  /// Begins with the belief of the crank's filter before a blow.
  void begin(const CrankFilter& crank, Gravity gravity) noexcept;
  /// Predicts by dt [s] > 0; supply, walks: those of the crank's filter.
  void move(double dt, const CrankWalks& walks, Gravity gravity) noexcept;
  /// Updates by a sample of the crank. Returns false if it contradicts the model.
  bool update(const WeighedSample& sample) noexcept;
  bool isRunning() const noexcept { return running_; }
  /// Ends without learning.
  void abandon() noexcept { running_ = false; }
  /// Keeps the identified values of rod and tool for the coming blows if the readings agreed; else resets them.
  void learn() noexcept;
  /// Logarithm of the likelihood of the samples since the beginning, without a constant.
  double fit() const noexcept { return fit_; }
  /// Returns true if the readings of the last blow agreed, so that the rod's estimate may be published.
  bool isProven() const noexcept { return proven_; }

  const RodMotion& motion() const noexcept { return motion_; }
  /// Returns true if it has moved since it began, so that there is a last step.
  bool hasMoved() const noexcept { return running_ && samples_ > 0; }
  /// Motion within the last step, predicted from the sample before; time: after that sample [s].
  RodMotion between(double time) const noexcept;
  /// Blow within that step, its time from the start of the step [s].
  const std::optional<TwoBodies::Blow>& blowOfStep() const noexcept { return blow_; }
  bool hasStruck() const noexcept { return motion_.state.angle.side == Side::kAfterBlow; }
  double sinceBlow() const noexcept { return since_blow_; }        ///< [s]
  double rockerBefore() const noexcept { return rocker_before_; }  ///< psi' at the tool [rad/s]
  /// Independent errors of one standard deviation each, as columns, increased where innovations exceed expectation.
  Belief::Matrix errors() const noexcept;
  /// Motion displaced by an error.
  RodMotion displaced(const Belief::Vector& by) const noexcept;
  /// Standard deviation of the friction radius [m], including the part that does not follow Coulomb's law.
  double frictionDeviation() const noexcept;
  double deviation(Row row) const noexcept { return std::sqrt(growth() * belief_.covariance(row, row)); }

  TwoBodyDrive drive(const RodMotion& m) const noexcept { return {m.inertia, m.torque, gravity_}; }
  const TwoBodies& bodies() const noexcept { return bodies_; }

 private:
  std::optional<TwoBodies::Blow> advance(double dt, bool strikes, RodMotion& motion,
                                         TwoBodies::LinksMemo& first) const noexcept;
  double growth() const noexcept;
  void addFriction(double dt) noexcept;

  double unknown_friction_{};  ///< standard deviation of the friction radius that is not identified [m]
  double rod_force_{};         ///< N [N]
  TwoBodies bodies_;
  Gravity gravity_;
  SupplyLaw supply_;
  RodMotion motion_, before_;  ///< at the last sample, at the one before
  std::optional<TwoBodies::Blow> blow_;
  Belief belief_;
  Belief::Matrix root_{Belief::Matrix::Zero()};                 ///< root of its covariance
  static constexpr Eigen::Index kLearned = kSize - kStiffness;  ///< the last rows
  using Learned = Eigen::Matrix<double, kLearned, kLearned>;
  RodMotion first_, learned_;  ///< rod, restitution and place alone
  Learned first_covariance_;
  Learned learned_covariance_;
  double fit_{};
  bool running_{}, proven_{};  ///< the last blow's readings agreed
  double since_blow_{}, rocker_before_{};
  double ratio_sum_{};  ///< sum of innovation^2 over its variance since the beginning
  int samples_{};
};

}  // namespace hammer_loads
