/// Deviation of the links' motion from that of a rigid rod after a blow, which the levels below `elastic` neglect.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/pipeline/crank_follower.h"

namespace hammer_loads {

class CrankFilter;

/// Rods that the hammer file allows. With little damping the vibration lasts longest, with much damping it peaks first.
/// With worn pins the rocker flies until the joint clearance is used up.
using Rods = std::array<RodSpring, 3>;
Rods rodsOf(const RodPrior& prior) noexcept;

/// The rocker leaves the tool with a speed other than that of the linkage, and at the dead centre the rod has no lever
/// h = l3 sin(psi - beta) on it. With x = psi - psi of the rigid linkage,
///
///     I x'' = -h^2 (k x + c x') - I psi_rigid'',  x(0) = 0,  x'(0) = R |u- w-| - u+ w+
///
/// the rocker gains speed as the lever opens, and vibrates. Within the joint clearance the spring has no force. At a
/// blank firing psi_rigid'' alone drives the rocker past the dead centre. The lever is lost before the dead centre: x
/// is followed from 30 deg on, where the rod is at rest on its spring. A wrench of rigid links lacks the effect of x''
/// and x'. Its phase depends on the uncertain stiffness, its magnitude does not: the mean square over the rods is used.
/// Each step is that of the oscillator with the lever at its middle.
class RodRing {
 public:
  /// Refers to the model; a rod given as rigid does not vibrate.
  explicit RodRing(const HullModel& model) noexcept;

  /// Restarts at the crank's last sample; the motion before it is not known. A crank behind the blow is assumed to have
  /// passed it with its present kinetic energy.
  void restart(const CrankFilter& tracker) noexcept;
  /// Follows the step to the crank's last sample, which the tracker has already followed.
  void follow(const CrankStep& step, const CrankFilter& tracker) noexcept;
  /// Takes the evidence of the crank's filter on a vibrating rod. lost, restitution: isLost() and restitution() of
  /// ElasticFollower. The vibration after an unexplained blow follows from the restitution of explained ones; the
  /// restitution of the blow itself is not known.
  void setEvidence(const CrankFilter& filter, bool lost, std::optional<double> restitution) noexcept;
  /// Returns the covariance of a rigid level's wrench due to acceleration() and speed(), whose square acts along the
  /// rocker. crank: speed [rad/s].
  Eigen::Matrix3d covariance(const LinkMotion& links, double crank) const noexcept;
  /// Returns the rms over the phase of the rocker's angular acceleration relative to the rigid links' [rad/s2].
  double acceleration() const noexcept { return moves_ ? share_ * acceleration_ : 0.0; }
  /// Returns the standard deviation of a restitution computed from the crank as if the rod were rigid [-].
  double restitutionDeviation(double restitution) const noexcept;
  /// Returns the standard deviation by which the crank's speed at the last blow may be too large [rad/s]. Reference is
  /// the speed with which a rigid mechanism's rocker strikes as fast. A rocker at one side of its joint clearance is
  /// slower than in the linkage, increasingly so towards the dead centre. Nothing brakes it within the clearance, so
  /// that it strikes with the largest speed at which it was driven.
  double lackingSpeed() const noexcept { return released_ * lacking_; }
  /// Returns the part of the rocker's speed that the last blow left for the rod to take up [rad/s].
  double struck() const noexcept { return is_elastic_ ? share_ * struck_ : 0.0; }
  /// Returns the root mean square of the rocker's angular speed relative to the rigid links' [rad/s].
  double speed() const noexcept;

 private:
  void stop() noexcept { moves_ = approaches_ = false, driven_ = 0.0; }
  void begin(double displacement_rate) noexcept;
  void strike(double speed_before, const BlowFactor& blow) noexcept;
  void move(const CrankStep& step, double from, double to) noexcept;
  void moveThrough(const CrankAngle& angle, double speed, double acceleration, double time) noexcept;
  void pass(const CrankStep::Passage& passage, const BlowFactor& blow) noexcept;
  void approach(const CrankAngle& at) noexcept;
  void drive(const CrankStep& step, const CrankEstimate& crank) noexcept;
  double deviationOf(double restitution) const noexcept;
  void release(const CrankStep::Passage& passage) noexcept;

  const HullModel* model_;
  bool is_elastic_, moves_{};      ///< moves: from the run-up on, which may turn out to be a blank firing
  bool approaches_{}, settles_{};  ///< in this run-up; it begins in the settled position
  struct State {
    double x{}, speed{};  ///< [rad], [rad/s]
  };
  Rods rods_;
  std::array<State, std::tuple_size_v<Rods>> states_;
  double acceleration_{}, struck_{}, share_{1.0}, released_{1.0};
  double driven_{};     ///< largest rocker speed of this stroke, with the most worn pins of the file [rad/s]
  double lacking_{};    ///< lacking crank speed at the last blow [rad/s]
  bool unexplained_{};  ///< no rod explains the last blow
  bool lost_{};         ///< no rod explains the effect of blows on the crank
  std::optional<double> explained_;  ///< restitution of the blows that a spring explains [-]
};

/// Returns the hull wrench of a rocker's angular acceleration [rad/s2]; for a speed [rad/s] its momentum [N s, N m s].
HullWrench rockerWrench(const Mechanism& mechanism, const LinkMotion& links, double acceleration) noexcept;
/// Returns the load that a tool takes off the hull by carrying the rocker, at rest at the dead centre, along z.
HullWrench rockerOnTool(const Mechanism& mechanism, const LinkMotion& links, Gravity gravity) noexcept;

}  // namespace hammer_loads
