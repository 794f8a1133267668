/// Deviation of the links' motion from that of a rigid rod after a blow, which the levels below `elastic` neglect.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/pipeline/crank_follower.h"

namespace hammer_loads {

class CrankFilter;

/// Rods that the file leaves possible. With little damping the vibration lasts longest, with much it peaks first, and
/// with worn pins the rocker flies until the joint clearance is used up.
using Rods = std::array<RodSpring, 3>;
Rods rodsOf(const RodPrior& prior) noexcept;

/// The rocker leaves the tool with its own speed, not with that which the linkage has there, and at the dead centre the
/// rod has no lever h = l3 sin(psi - beta) on it. With x = psi - psi of the rigid linkage,
///
///     I x'' = -h^2 (k x + c x') - I psi_rigid'',  x(0) = 0,  x'(0) = R |u- w-| - u+ w+
///
/// the rocker picks up speed as the lever opens, and vibrates; within the joint clearance the spring has no force. A
/// rocker that meets no tool is driven past the dead centre by psi_rigid'' alone. Before it the lever is lost: from 30
/// deg on, where the rod is at rest on its spring, x is followed. A wrench of rigid links lacks the effect of x'' and
/// x'. Its phase depends on a stiffness that is hardly known, its size does not: the mean square over the rods counts.
/// Each step is that of the oscillator with the lever at its middle.
class RodRing {
 public:
  /// Refers to the model; a rod given as rigid does not vibrate.
  explicit RodRing(const HullModel& model) noexcept;

  /// Restarts at the crank's last sample; the motion before it is not known. A crank behind the blow has passed it with
  /// the kinetic energy that it has now.
  void restart(const CrankFilter& tracker) noexcept;
  /// Over the step to the crank's last sample; the tracker has followed it.
  void follow(const CrankStep& step, const CrankFilter& tracker) noexcept;
  /// Takes the evidence of the crank's filter on a vibrating rod. lost, restitution: isLost() and restitution() of
  /// ElasticFollower. The vibration after an unexplained blow is that by the restitution of the explained ones; the
  /// restitution of the blow itself is not known.
  void setEvidence(const CrankFilter& filter, bool lost, std::optional<double> restitution) noexcept;
  /// Standard deviation of a rigid level's wrench by acceleration() and speed(), whose square pulls along the rocker.
  /// crank: speed [rad/s].
  Eigen::Matrix3d covariance(const LinkMotion& links, double crank) const noexcept;
  /// Root mean square over the phase of the rocker's angular acceleration relative to the rigid links' [rad/s2].
  double acceleration() const noexcept { return moves_ ? share_ * acceleration_ : 0.0; }
  /// Standard deviation of a restitution that is computed from the crank as if the rod were rigid [-].
  double restitutionDoubt(double restitution) const noexcept;
  /// Standard deviation by which the crank's speed at the last blow may exceed that which drives a rigid mechanism's
  /// rocker as fast as this one struck [rad/s]. A rocker at the side of its joint clearance is slower than the linkage
  /// predicts, the more so the nearer the dead centre. Nothing brakes it within the joint clearance: it strikes with
  /// the most it was driven at.
  double lackingSpeed() const noexcept { return released_ * lacking_; }
  /// Part of the rocker's speed that the last blow left for the rod to take up [rad/s].
  double struck() const noexcept { return is_elastic_ ? share_ * struck_ : 0.0; }
  /// Root mean square of the rocker's angular speed relative to the rigid links' [rad/s].
  double speed() const noexcept;

 private:
  void stop() noexcept { moves_ = approaches_ = false, driven_ = 0.0; }
  void begin(double beside_speed) noexcept;
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
  bool approaches_{}, settles_{};  ///< in this run-up, which began settled
  struct State {
    double x{}, speed{};  ///< [rad], [rad/s]
  };
  Rods rods_;
  std::array<State, std::tuple_size_v<Rods>> states_;
  double acceleration_{}, struck_{}, share_{1.0}, released_{1.0};
  double driven_{};                  ///< the most of this stroke, in pins as worn as the file leaves possible [rad/s]
  double lacking_{};                 ///< at the last blow, of the crank's speed [rad/s]
  bool unexplained_{};               ///< no rod explains the last blow
  bool lost_{};                      ///< nothing explains what blows did to the crank
  std::optional<double> explained_;  ///< restitution of the blows that a spring explains [-]
};

/// Wrench on the hull of a rocker's angular acceleration [rad/s2]; for a speed [rad/s] its momentum [N s, N m s].
HullWrench rockerWrench(const Mechanism& mechanism, const LinkMotion& links, double acceleration) noexcept;
/// Load that a tool takes off the hull carrying the rocker, at rest at the dead centre: it pushes along z there.
HullWrench rockerOnTool(const Mechanism& mechanism, const LinkMotion& links, Gravity gravity) noexcept;

}  // namespace hammer_loads
