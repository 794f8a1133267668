/// Level elastic around a blow: the crank and what the rocker beside its rigid place does to the hull.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/crank/rod_filter.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/step_impulse.h"

namespace hammer_loads {

constexpr double kRingStep = 2e-4;  ///< [s] between points of its path: a tenth of a period at 500 Hz
// Numerical: kRingStep

/// Elsewhere, and where readings contradict the rod's model, the machine is that of level linkage.
class ElasticFollower {
 public:
  /// Below level elastic it never runs. Refers to the model, which must outlive it; may not be moved.
  ElasticFollower(const HullModel& model, Level level) noexcept;

  ElasticFollower(const ElasticFollower&) = delete;
  ElasticFollower& operator=(const ElasticFollower&) = delete;

  void pause() noexcept;
  /// Over the step to the crank's last sample, which continued.
  void follow(const CrankFollower& crank, Gravity gravity) noexcept {
    if (wanted_) followRods(crank, gravity);
  }
  /// True if no rod explains the effect of the last blow on the crank by two bodies and a tool near the dead centre.
  bool isLost() const noexcept { return lost_; }
  /// Restitution of the last blow that a spring explained [-]; empty if a rigid rod explains the recent blows better.
  std::optional<double> restitution() const noexcept {
    return best_ != nullptr ? std::make_optional(restitution_) : std::nullopt;
  }
  /// Empty if the readings show no spring.
  std::optional<IdentifiedPins> identifiedPins() const noexcept {
    return isUsed() ? std::make_optional(pins_) : std::nullopt;
  }
  bool isWanted() const noexcept { return wanted_; }  ///< level elastic, and a spring may be there
  /// The spring is followed around each blow; elsewhere the machine is that of level linkage.
  bool isUsed() const noexcept { return best_ != nullptr && best_->isProven(); }
  /// Reason why the spring is not used.
  const char* whyNotUsed() const noexcept;
  bool runs() const noexcept { return isUsed() && best_->isRunning(); }

  /// While it runs: the crank as the two bodies have it, its acceleration as if its rod were rigid.
  CrankEstimate crank() const noexcept { return crankOf(filter().motion()); }
  /// Loads that an elastic rod adds to those of a rigid rod at the same crank motion.
  struct RodLoads {
    HullWrench wrench;
    Eigen::Matrix3d covariance;  ///< covariance of the whole wrench by readings and rod
    double crank{};              ///< acceleration [rad/s2]
  };
  /// Once a sample. ring: of the rocker's acceleration beside a rigid rod's, of any phase (RodRing) [rad/s2]. The
  /// acceleration of the two bodies is weighted with it by the variances, or with its own mean since the blow where
  /// that is larger, as the moment of an impact within the pins is known no better.
  RodLoads rodLoads(const DriveReaction& drive, double ring) noexcept;
  /// Acceleration of the rocker beside that of a rigid rod at the last rodLoads() [rad/s2].
  double vibration() const noexcept { return vibration_; }
  /// While it runs: pin forces with the links' motion as the spring determines it.
  PinReactions pins(const HullMotion& hull, const NearBlow& near) const noexcept;
  /// While it runs: of a crank whose rigid rod moves the rocker as it is before the blow [rad/s].
  double strikingSpeed() const noexcept;
  /// Blow that was struck while it runs: the rocker's speed at the tool and its restitution, as a crank would feel them
  /// whose rod takes the rocker along at once.
  std::optional<CrankBlow> blow() const noexcept;
  /// Contact lasts, or may have begun or not.
  bool isBesideBlow() const noexcept;

  /// Returns true if it runs and has done so over the step to the crank's last sample. The functions below apply to
  /// that step; times count from its start [s].
  bool ranOverStep() const noexcept { return runs() && best_->hasMoved(); }
  CrankEstimate crankAt(double time) const noexcept { return crankOf(motionAt(time)); }
  /// With what an elastic rod adds; the deviations of the samples stand for its own.
  struct Instant {
    CrankEstimate crank;
    HullWrench wrench;
    TwoBodyState bodies;
    LinkMotion links;  ///< links of a rigid rod
  };
  Instant at(double time, const DriveReaction& drive, const HullMotion& hull) const noexcept {
    return instantOf(motionAt(time), true, drive, hull);
  }
  /// Instant by the two bodies alone, unweighted; at the step's end the state before the sample there. The uncertain
  /// moment of an impact affects the force at a given time, but not its extreme.
  Instant onItsWay(double time, const DriveReaction& drive, const HullMotion& hull) const noexcept {
    return instantOf(filter().between(time), false, drive, hull);
  }
  bool isBesideBlowAt(double time) const noexcept;
  /// Momentum of links and drive, relative to the hull; links: as those of a rigid rod.
  LoadImpulse momentum(const TwoBodyState& bodies, const LinkMotion& links, const DriveReaction& drive) const noexcept;
  /// Impulse like motionImpulse(), which leaves out the jump at the blow as well; doubt: standard deviation by the
  /// uncertain restitution.
  struct Impulse {
    LoadImpulse motion;
    HullWrench doubt;
  };
  Impulse impulse(const DriveReaction& drive, double from, double to) const noexcept;
  /// Standard deviation of the momentum of links and drive at the sample [N s, N s, N m s].
  HullWrench momentumDeviation(const DriveReaction& drive) const noexcept;
  /// While it runs: with pins tight, or with joint clearance where the last blow showed one.
  const RodFilter& filter() const noexcept { return best_ != nullptr ? *best_ : filters_[0]; }

 private:
  /// Loads on the hull as HullWrench; acceleration of the crank, and x'' of the rocker relative to a rigid rod's
  /// [rad/s2].
  using Loads = Eigen::Matrix<double, 5, 1>;
  using LoadCovariance = Eigen::Matrix<double, 5, 5>;
  enum : Eigen::Index { kCrank = 3, kBesideRigid = 4 };
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
  /// Weights the vibration in the loads as rodLoads() does.
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
  int blows_{};   ///< judged
  bool alone_{};  ///< the likelier filter alone, at this blow
  std::array<RodFilter, 2> filters_;
  double evidence_{};          ///< mean over some blows of the rod's fit less that of the rigid mechanism
  double rigid_fit_{};         ///< fit of the rigid mechanism at this blow
  const RodFilter* best_{};    ///< null: rigid
  double restitution_{};       ///< restitution()
  IdentifiedPins pins_;        ///< identifiedPins()
  std::int64_t blow_{};        ///< CrankPosition::blow
  double late_{};              ///< standard deviation of what all stamps are off alike [s]
  RunningMean<> squares_;      ///< mean square of x'' since the blow [rad2/s4]
  double length_{};            ///< length of the last step [s]
  double vibration_{};         ///< x'' at the last sample [rad/s2]
  Loads gain_{Loads::Zero()};  ///< derivative of rodLoads()'s correction by x''
};

}  // namespace hammer_loads
