/// Level elastic around a blow: the crank, and the hull loads due to the rocker's motion relative to a rigid rod's.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/crank/rod_filter.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/step_impulse.h"

namespace hammer_loads {

constexpr double kRingStep = 2e-4;  ///< [s] between points of a path: a tenth of a period at 500 Hz
// Numerical: kRingStep

/// Follows an elastic connecting rod. Away from blows, and where readings contradict its model, level linkage applies.
class ElasticFollower {
 public:
  /// Refers to the model, which must outlive it; may not be moved. Below level elastic it never runs.
  ElasticFollower(const HullModel& model, Level level) noexcept;

  ElasticFollower(const ElasticFollower&) = delete;
  ElasticFollower& operator=(const ElasticFollower&) = delete;

  void pause() noexcept;
  /// Follows the step to the crank's last sample, which continued the one before.
  void follow(const CrankFollower& crank, Gravity gravity) noexcept {
    if (wanted_) followRods(crank, gravity);
  }
  /// Returns true if no rod explains the last blow's effect on the crank by two bodies and a tool near the dead centre.
  bool isLost() const noexcept { return lost_; }
  /// Returns the restitution of the last blow explained by a spring [-]; empty if a rigid rod fits recent blows better.
  std::optional<double> restitution() const noexcept {
    return best_ != nullptr ? std::make_optional(restitution_) : std::nullopt;
  }
  /// Returns the pins; empty if the readings show no spring.
  std::optional<IdentifiedPins> identifiedPins() const noexcept {
    return isUsed() ? std::make_optional(pins_) : std::nullopt;
  }
  bool isWanted() const noexcept { return wanted_; }  ///< level elastic, and the rod may be elastic
  /// Returns true if the spring is followed around each blow; elsewhere the machine is that of level linkage.
  bool isUsed() const noexcept { return best_ != nullptr && best_->isProven(); }
  /// Returns the reason why the spring is not used.
  const char* whyNotUsed() const noexcept;
  bool runs() const noexcept { return isUsed() && best_->isRunning(); }

  /// Returns the crank of the two bodies, with the acceleration of a rigid rod. Valid while it runs.
  CrankEstimate crank() const noexcept { return crankOf(filter().motion()); }
  /// Loads that an elastic rod adds to those of a rigid rod at the same crank motion.
  struct RodLoads {
    HullWrench wrench;
    Eigen::Matrix3d covariance;  ///< covariance of the whole wrench by readings and rod
    double crank{};              ///< acceleration [rad/s2]
  };
  /// Returns these loads; call once per sample. ring: acceleration of the rocker relative to a rigid rod's, with any
  /// phase (RodRing) [rad/s2]. The acceleration of the two bodies is weighted against it by the variances. Its own mean
  /// since the blow replaces ring where larger, as the instant of an impact within the pins is uncertain.
  RodLoads rodLoads(const DriveReaction& drive, double ring) noexcept;
  /// Returns the acceleration of the rocker relative to that of a rigid rod at the last rodLoads() [rad/s2].
  double vibration() const noexcept { return vibration_; }
  /// Returns pin forces with the links' motion as the spring determines it. Valid while it runs.
  PinReactions pins(const HullMotion& hull, const NearBlow& near) const noexcept;
  /// Returns the speed of a crank whose rigid rod moves the rocker as before the blow [rad/s]. Valid while it runs.
  double strikingSpeed() const noexcept;
  /// Returns the blow that was struck while it runs: rocker speed at the tool and restitution. They are those of an
  /// equivalent crank with a rigid rod.
  std::optional<CrankBlow> blow() const noexcept;
  /// Returns true if the contact lasts, or may or may not have begun.
  bool isBesideBlow() const noexcept;

  /// Returns true if it runs and has done so over the step to the crank's last sample. The functions below apply to
  /// that step; times count from its start [s].
  bool ranOverStep() const noexcept { return runs() && best_->hasMoved(); }
  CrankEstimate crankAt(double time) const noexcept { return crankOf(motionAt(time)); }
  /// Crank and loads, including those that an elastic rod adds. The samples' standard deviations apply to them.
  struct Instant {
    CrankEstimate crank;
    HullWrench wrench;
    TwoBodyState bodies;
    LinkMotion links;  ///< links of a rigid rod
  };
  Instant at(double time, const DriveReaction& drive, const HullMotion& hull) const noexcept {
    return instantOf(motionAt(time), true, drive, hull);
  }
  /// Returns the instant from the two bodies alone, unweighted; at the step's end the state before the sample there.
  /// The uncertain moment of an impact affects the force at a given time, but not its extreme.
  Instant byBodies(double time, const DriveReaction& drive, const HullMotion& hull) const noexcept {
    return instantOf(filter().between(time), false, drive, hull);
  }
  bool isBesideBlowAt(double time) const noexcept;
  /// Returns the momentum of links and drive, relative to the hull. links: those of a rigid rod.
  LoadImpulse momentum(const TwoBodyState& bodies, const LinkMotion& links, const DriveReaction& drive) const noexcept;
  /// Impulse like motionImpulse(), which excludes the jump at the blow as well. doubt: standard deviation due to the
  /// uncertain restitution.
  struct Impulse {
    LoadImpulse motion;
    HullWrench deviation;
  };
  Impulse impulse(const DriveReaction& drive, double from, double to) const noexcept;
  /// Returns the standard deviation of the momentum of links and drive at the sample [N s, N s, N m s].
  HullWrench momentumDeviation(const DriveReaction& drive) const noexcept;
  /// Returns the filter in use: with tight pins, or with joint clearance where the last blow showed one.
  const RodFilter& filter() const noexcept { return best_ != nullptr ? *best_ : filters_[0]; }

 private:
  /// Loads on the hull as HullWrench; acceleration of the crank, and x'' of the rocker relative to a rigid rod's
  /// [rad/s2].
  using Loads = Eigen::Matrix<double, 5, 1>;
  using LoadCovariance = Eigen::Matrix<double, 5, 5>;
  enum : Eigen::Index { kCrank = 3, kDisplacementAcceleration = 4 };
  RodMotion motionAt(double time) const noexcept { return time < length_ ? filter().between(time) : filter().motion(); }
  CrankEstimate crankOf(const RodMotion& motion) const noexcept;
  Instant instantOf(const RodMotion& motion, bool weighed, const DriveReaction& drive,
                    const HullMotion& hull) const noexcept;
  bool mayTouch(const RodMotion& motion) const noexcept;
  LoadImpulse momentumOf(const TwoBodyState& s, const DriveReaction& drive) const noexcept {
    return momentum(s, filter().bodies().links(s.angle), drive);
  }
  /// links: as those of a rigid rod.
  Loads loads(const RodMotion& motion, const LinkMotion& links, const DriveReaction& drive) const noexcept;
  Loads rigidLoads(const RodMotion& motion, const LinkMotion& links, const DriveReaction& drive) const noexcept;
  /// Weights the vibration in the loads as in rodLoads().
  void weightVibration(const RodMotion& motion, Loads& loads) const noexcept;
  LoadCovariance covariance(const DriveReaction& drive, const LinkMotion& links, const Loads& here) const noexcept;
  void followRods(const CrankFollower& crank, Gravity gravity) noexcept;
  void begin(const CrankFollower& crank, const CrankFilter& filter, Gravity gravity) noexcept;
  const RodFilter& likelier() const noexcept;
  bool runsAlone(std::int64_t blow) const noexcept;
  void judge() noexcept;
  bool mayBegin(const CrankFollower& crank, const CrankFilter& filter) const noexcept;

  const HullModel* model_;
  bool wanted_, runs_{};
  bool lost_{}, too_coarse_{};
  int blows_{};   ///< number of blows judged
  bool alone_{};  ///< only the likelier filter runs at this blow
  std::array<RodFilter, 2> filters_;
  double evidence_{};          ///< mean over some blows of the rod's fit minus that of the rigid mechanism
  double rigid_fit_{};         ///< fit of the rigid mechanism at this blow
  const RodFilter* best_{};    ///< null: rigid
  double restitution_{};       ///< restitution()
  IdentifiedPins pins_;        ///< identifiedPins()
  std::int64_t blow_{};        ///< CrankPosition::blow
  double late_{};              ///< standard deviation of the common shift of all stamps [s]
  RunningMean<> squares_;      ///< mean square of x'' since the blow [rad2/s4]
  double length_{};            ///< length of the last step [s]
  double vibration_{};         ///< x'' at the last sample [rad/s2]
  Loads gain_{Loads::Zero()};  ///< derivative of the correction in rodLoads() with respect to x''
};

}  // namespace hammer_loads
